#include <semloop/slam/PathLine.h>

namespace semloop
{
mrpt::opengl::CSetOfLines::Ptr pathLine(
	const Trajectory& trajectory, const mrpt::img::TColor& color, float dotSize)
{
	const bool hasDots = dotSize > 0;
	auto line = mrpt::opengl::CSetOfLines::Create();
	line->setColor_u8(color);
	line->setLineWidth(hasDots ? 1 : 2);
	line->enableAntiAliasing(!hasDots);
	line->setVerticesPointSize(dotSize);
	for (std::size_t i = 1; i < trajectory.size(); ++i)
		line->appendLine(trajectory[i - 1].pose.translation(), trajectory[i].pose.translation());
	return line;
}

}  // namespace semloop
