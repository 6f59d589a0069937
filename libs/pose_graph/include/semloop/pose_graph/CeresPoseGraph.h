#pragma once

#include <semloop/config/Options.h>
#include <semloop/pose_graph/PoseGraph.h>

#include <string>

namespace semloop
{
struct CeresPoseGraphOptions : Options
{
	int maxIterations = 100;
	std::string loopLoss = "cauchy";
	double loopLossScale =
		3.5;  //!< of the whitened residual: about its 95 % quantile (chi^2, 6 dof)
	double functionTolerance = 1e-8;
	double gradientTolerance = 1e-10;
	double parameterTolerance = 1e-10;

protected:
	void describe(OptionFields& fields) override;
};

/** Levenberg-Marquardt with sparse Cholesky factorisation (Ceres), as the paper has it.
 *
 *  A node is a unit quaternion and a translation; the solver moves it by a step (rho, phi) of six
 *  numbers in its own frame, t + R rho and q (x) exp(phi), which is mrpt::poses::Lie::SE<3>'s chart.
 *  Residuals are whitened by the Cholesky factor of the information matrix, L^T e with L L^T =
 *  information, and their Jacobians are analytic. One thread: the same graph gives the same bits. */
class CeresPoseGraph : public PoseGraph
{
	DEFINE_MRPT_OBJECT(CeresPoseGraph, semloop)

public:
	void configure(
		const mrpt::config::CConfigFileBase& config, const std::string& section) override;
	OptimizationReport optimize() override;

	CeresPoseGraphOptions options;
};

}  // namespace semloop
