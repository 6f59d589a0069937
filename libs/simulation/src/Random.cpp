#include "Random.h"

#include <cmath>

namespace semloop
{
namespace
{
// Where the outermost pieces of the table end, in place of infinity: chosen so that the variance is 1.
constexpr float kTableEnd = 4.0F;

/** (a[0] + a[1] x + ...) / (1 + b[0] x + ...) */
template <std::size_t N, std::size_t M>
double ratio(const double (&a)[N], const double (&b)[M], double x)
{
	double above = 0, below = 0;
	for (std::size_t i = N; i-- > 0;) above = above * x + a[i];
	for (std::size_t i = M; i-- > 0;) below = (below + b[i]) * x;
	return above / (below + 1);
}
}  // namespace

uint64_t hashedText(std::string_view text)
{
	uint64_t h = 0xCBF29CE484222325U;
	for (const char c : text) h = (h ^ uint8_t(c)) * 0x100000001B3U;
	return h;
}

double normalQuantile(double p)
{
	const double q = p - 0.5;
	if (std::abs(q) <= 0.425)
		return q * ratio(
					   {3.3871327179, 50.434271938, 159.29113202, 59.109374720},
					   {17.895169469, 78.757757664, 67.187563600}, 0.180625 - q * q);
	const double r = std::sqrt(-std::log(q < 0 ? p : 1 - p));
	const double x = r <= 5 ? ratio(
								  {1.4234372777, 2.7568153900, 1.3067284816, 0.17023821103},
								  {0.73700164250, 0.12021132975}, r - 1.6)
							: ratio(
								  {6.6579051150, 3.0812263860, 0.42868294337, 0.017337203997},
								  {0.24197894225, 0.012258202635}, r - 5);
	return q < 0 ? -x : x;
}

NormalTable::NormalTable()
{
	for (uint64_t i = 1; i < kPieces; i++)
		nodes_[i] = float(normalQuantile(double(i) / double(kPieces)));
	nodes_[0] = -kTableEnd;
	nodes_[kPieces] = kTableEnd;
}

const NormalTable& normalTable()
{
	static const NormalTable table;
	return table;
}

int RandomStream::poisson(double rate)
{
	const double limit = std::exp(-rate);
	int events = 0;
	for (double product = uniform(); product > limit; product *= uniform()) events++;
	return events;
}

}  // namespace semloop
