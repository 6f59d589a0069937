#include <semloop/loop_closure/LoopDetector.h>

#include <stdexcept>

IMPLEMENTS_VIRTUAL_MRPT_OBJECT(LoopDetector, mrpt::rtti::CObject, semloop)

namespace semloop
{
const char* toString(LoopVerdict::Decision decision)
{
	switch (decision)
	{
		case LoopVerdict::Decision::Accepted:
			return "accepted";
		case LoopVerdict::Decision::Rejected:
			return "rejected";
		case LoopVerdict::Decision::Ambiguous:
			return "ambiguous";
	}
	throw std::invalid_argument("a decision that has no name");
}

}  // namespace semloop
