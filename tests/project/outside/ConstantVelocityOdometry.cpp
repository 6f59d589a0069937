#include <mrpt/core/initializer.h>
#include <semloop/config/Options.h>
#include <semloop/odometry/Odometry.h>

namespace outside
{
struct ConstantVelocityOptions : semloop::Options
{
	double speed = 0.1;  //!< forward [m per frame]

protected:
	void describe(semloop::OptionFields& fields) override
	{
		fields.number("speed", speed, 0, 100, "forward motion between two frames [m]");
	}
};

/** A third party's module: believes that the camera moves straight on. */
class ConstantVelocityOdometry : public semloop::Odometry
{
	DEFINE_MRPT_OBJECT(ConstantVelocityOdometry, outside)

public:
	void configure(const mrpt::config::CConfigFileBase& config, const std::string& section) override
	{
		options_.loadFromConfigFile(config, section);
	}

	semloop::OdometryEstimate track(const semloop::RgbdFrame&) override
	{
		semloop::OdometryEstimate estimate;
		if (frames_++ > 0) estimate.T_previous_camera.z(options_.speed);
		T_odom_camera_ = T_odom_camera_ + estimate.T_previous_camera;
		estimate.T_odom_camera = T_odom_camera_;
		return estimate;
	}

private:
	ConstantVelocityOptions options_;
	mrpt::poses::CPose3D T_odom_camera_;
	int frames_ = 0;
};
}  // namespace outside

IMPLEMENTS_MRPT_OBJECT(ConstantVelocityOdometry, semloop::Odometry, outside)

MRPT_INITIALIZER(registerConstantVelocityOdometry)
{
	mrpt::rtti::registerClass(CLASS_ID(outside::ConstantVelocityOdometry));
}
