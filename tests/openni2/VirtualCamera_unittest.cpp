#include "CameraFixture.h"

namespace semloop::test
{
namespace
{
using testing::HasSubstr;

class VirtualCamera : public CameraFixture
{
};

TEST_F(VirtualCamera, IsTheOneDeviceThatOpenNi2Finds)
{
	const auto result = recorder("list");
	EXPECT_EQ(result.code, 0) << result.err;
	EXPECT_EQ(result.out, "semloop://camera virtual camera\n");
}

TEST_F(VirtualCamera, WithoutARawlogThereIsNone)
{
	const auto result = shell(
		virtualCamera("") + "timeout 60 '" SEMLOOP_BINARY_DIR "/openni2/oni-recorder' list",
		folder_.path());
	EXPECT_EQ(result.code, 0) << result.err;
	EXPECT_EQ(result.out, "");
}

TEST_F(VirtualCamera, TellsAWrongSettingInALineAndIsNotThere)
{
	const std::vector<std::pair<std::string, std::string>> wrong = {
		{"RATE", "fast"}, {"RATE", "0"},   {"RATE", "nan"},  {"RATE", "30x"},  {"DROP", "-1"},
		{"DROP", "1.5"},  {"STALL", "10"}, {"STALL", "10:"}, {"STALL", "a:1"}, {"UNPLUG", "0"}};
	for (const auto& [name, value] : wrong)
	{
		const auto result = recorder("list", {{name, value}});
		EXPECT_EQ(result.out, "") << name << value;
		EXPECT_THAT(result.err, HasSubstr("SEMLOOP_CAMERA_" + name + "=" + value + ": must be "));
		EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
	}
}

TEST_F(VirtualCamera, TellsThatItsRawlogIsMissing)
{
	const auto result = shell(
		virtualCamera("none.rawlog") + "timeout 60 '" SEMLOOP_BINARY_DIR
									   "/openni2/oni-recorder' record x.oni",
		folder_.path());
	EXPECT_EQ(result.code, 1);
	EXPECT_THAT(result.err, HasSubstr("virtual camera: none.rawlog: "));
}

TEST_F(VirtualCamera, TakesTheModesOfItsSensorsOnly)
{
	EXPECT_EQ(recorder("set-mode 64 48").code, 0);
	EXPECT_EQ(recorder("set-mode 640 480").code, 1);
}

TEST_F(VirtualCamera, CanBeClosedByWhoeverIsToldThatItIsGone)
{
	const auto result = recorder("close-when-unplugged", {{"RATE", "100"}, {"UNPLUG", "3"}});
	EXPECT_EQ(result.code, 0) << result.err;
}

}  // namespace
}  // namespace semloop::test
