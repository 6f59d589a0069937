// OpenNI's headers want the name that compilers had before they knew of standards.
#ifndef linux
#define linux 1
#endif
#include <OpenNI.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <thread>

/** What tests need of OpenNI2 in a process of their own: which devices it finds, and a recording of the
 *  first one until it is unplugged.
 *
 *      oni-recorder list
 *      oni-recorder record|record-depth|record-color|record-mirrored OUT.oni
 *      oni-recorder set-mode WIDTH HEIGHT
 *      oni-recorder close-when-unplugged      from the thread that tells it
 *
 *  Exit codes: 0 done, 1 not done, 2 wrong usage. */
namespace
{
using namespace openni;
using namespace std::chrono_literals;

void require(Status status, const std::string& what)
{
	if (status != STATUS_OK)
		throw std::runtime_error(what + " failed: " + OpenNI::getExtendedError());
}

class Unplugging : public OpenNI::DeviceDisconnectedListener
{
public:
	Unplugging() { OpenNI::addDeviceDisconnectedListener(this); }
	~Unplugging() override { OpenNI::removeDeviceDisconnectedListener(this); }
	void onDeviceDisconnected(const DeviceInfo*) override { seen = true; }

	std::atomic<bool> seen{false};
};

struct Camera
{
	Camera()
	{
		require(device.open(ANY_DEVICE), "opening the camera");
		require(depth.create(device, SENSOR_DEPTH), "depth stream");
		require(color.create(device, SENSOR_COLOR), "colour stream");
	}
	~Camera() { close(); }
	void close()
	{
		depth.destroy();
		color.destroy();
		device.close();
	}

	Device device;
	VideoStream depth, color;
};

int list()
{
	Array<DeviceInfo> devices;
	OpenNI::enumerateDevices(&devices);
	for (int i = 0; i < devices.getSize(); i++)
		std::printf("%s %s\n", devices[i].getUri(), devices[i].getName());
	return 0;
}

/** Whether the depth sensor takes a mode. */
int setMode(int width, int height)
{
	Camera camera;
	VideoMode mode = camera.depth.getVideoMode();
	mode.setResolution(width, height);
	return camera.depth.setVideoMode(mode) == STATUS_OK ? 0 : 1;
}

int closeWhenUnplugged()
{
	Camera camera;
	struct Closing : OpenNI::DeviceDisconnectedListener
	{
		explicit Closing(Camera& toClose) : camera(toClose)
		{
			OpenNI::addDeviceDisconnectedListener(this);
		}
		~Closing() override { OpenNI::removeDeviceDisconnectedListener(this); }
		void onDeviceDisconnected(const DeviceInfo*) override
		{
			camera.close();
			done = true;
		}
		Camera& camera;
		std::atomic<bool> done{false};
	} closing(camera);
	require(camera.depth.start(), "depth");
	require(camera.color.start(), "colour");
	while (!closing.done) std::this_thread::sleep_for(5ms);
	return 0;
}

int record(const std::string& what, const std::string& path)
{
	Unplugging unplugged;
	Camera camera;
	if (what == "record-mirrored")
	{
		require(camera.depth.setMirroringEnabled(true), "mirroring");
		require(camera.color.setMirroringEnabled(true), "mirroring");
	}
	Recorder recorder;
	require(recorder.create(path.c_str()), "recorder");
	if (what != "record-color") require(recorder.attach(camera.depth), "recording depth");
	if (what != "record-depth") require(recorder.attach(camera.color, false), "recording colour");
	require(recorder.start(), "recording");
	// It begins in a thread of its own, and what comes before is lost.
	std::this_thread::sleep_for(300ms);
	require(camera.depth.start(), "depth");
	require(camera.color.start(), "colour");
	while (!unplugged.seen) std::this_thread::sleep_for(5ms);
	recorder.stop();
	recorder.destroy();
	return 0;
}

int run(int argc, char** argv)
{
	const std::string command = argc > 1 ? argv[1] : "";
	require(OpenNI::initialize(), "OpenNI2");
	int code = 2;
	if (command == "list" && argc == 2) code = list();
	if (command == "set-mode" && argc == 4) code = setMode(std::stoi(argv[2]), std::stoi(argv[3]));
	if (command == "close-when-unplugged" && argc == 2) code = closeWhenUnplugged();
	if (command.rfind("record", 0) == 0 && argc == 3) code = record(command, argv[2]);
	OpenNI::shutdown();
	return code;
}
}  // namespace

int main(int argc, char** argv)
{
	try
	{
		return run(argc, argv);
	}
	catch (const std::exception& e)
	{
		std::fprintf(stderr, "oni-recorder: %s\n", e.what());
		return 1;
	}
}
