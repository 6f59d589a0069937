#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/rtti/CObject.h>
#include <mrpt/system/os.h>
#include <semloop/config/ModuleFactory.h>
#include <semloop/observations/CObservationInstances.h>
#include <semloop/odometry/Odometry.h>
#include <semloop/pose_graph/PoseGraph.h>
#include <semloop/slam/SlamOptions.h>

#include <cmath>
#include <iostream>
#include <string>

/** use-semloop PLUGIN.so: makes modules by name, those of semloop and the plug-in's. */
int main(int argc, char** argv)
{
	if (argc != 2)
	{
		std::cerr << "usage: use-semloop PLUGIN.so\n";
		return 2;
	}
	std::string errors;
	if (!mrpt::system::loadPluginModules(argv[1], errors))
	{
		std::cerr << argv[1] << ": " << errors << "\n";
		return 1;
	}

	// By MRPT's class factory ...
	const auto odometry = std::dynamic_pointer_cast<semloop::Odometry>(
		mrpt::rtti::classFactory("outside::ConstantVelocityOdometry"));
	if (!odometry)
	{
		std::cerr << "the plug-in's odometry is not registered\n";
		return 1;
	}
	mrpt::config::CConfigFileMemory config;
	config.write("odometry", "speed", 0.25);
	odometry->configure(config, "odometry");
	odometry->track({});
	const double travelled = odometry->track({}).T_odom_camera.z();
	if (std::abs(travelled - 0.25) > 1e-12)
	{
		std::cerr << "the plug-in's odometry moved by " << travelled << " m, not 0.25\n";
		return 1;
	}

	// ... and by semloop's, which complains by name.
	const semloop::ModuleNames names;
	const auto graph = semloop::makeModule<semloop::PoseGraph>(names.poseGraph, "use-semloop");
	graph->setNode(semloop::NodeId::camera(0), {});
	const semloop::CObservationInstances nothingSeen;
	std::cout << "outside::ConstantVelocityOdometry and " << names.poseGraph << " work; "
			  << graph->nodes().size() << " node, " << nothingSeen.instances.size()
			  << " instances\n";
	return 0;
}
