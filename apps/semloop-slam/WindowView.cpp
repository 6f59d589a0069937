#include "WindowView.h"

#include <mrpt/core/bits_math.h>
#include <mrpt/core/format.h>
#include <mrpt/math/wrap2pi.h>
#include <semloop/observations/InstancePicture.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace semloop
{
namespace
{
constexpr int kWidth = 1280, kHeight = 960;  // of the window [pixels]
constexpr int kColumn = 480;                 // of picture and panel
constexpr int kMargin = 10, kPadding = 12;
constexpr int kFontSize = 18;

constexpr double kAhead = 1.5;           // the view's centre before the camera [m]
constexpr float kViewDistance = 4.5f;    // [m]
constexpr float kViewElevation = 45.0f;  // [degrees]
constexpr double kTurningTime = 1.0;     // in which the view makes 1 - 1/e of a turn [s]
constexpr double kNoTurn = 0.01;         // [rad]
constexpr double kLevel = 0.3;           // an axis that is less horizontal than that has no heading

constexpr std::chrono::milliseconds kMeshingTime(30);  // before the window looks at the user again
constexpr std::chrono::milliseconds kWaiting(40);
constexpr std::chrono::milliseconds kLongestWithoutDrawing(500);  // tooltips come and go
constexpr int kIdlePerDrawing = 2;  // leaves most of a processor to the run where drawing is slow
}  // namespace

WindowView::WindowView(const std::string& title, RunControl& control, std::function<void()> onLost)
	: glfw_(std::move(onLost)), control_(control), window_(title, kWidth, kHeight)
{
	window_.background_scene = mrpt::opengl::COpenGLScene::Create();
	scene_.emplace(*window_.background_scene->getViewport());
	picture_ = window_.background_scene->createViewport("picture");

	auto& camera = window_.camera();
	camera.setMinimumZoom(0.2f);
	camera.setZoomDistance(kViewDistance);
	camera.setElevationDegrees(kViewElevation);
	camera.setCameraFOV(50.0f);
	viewedFrom_ = camera.cameraParams();

	makePanel();
	window_.addKeyboardCallback([this](int key, int, int action, int)
								{ return pressKey(key, action); });
	window_.performLayout();
	window_.setVisible(true);
	arrange();
	window_.drawAll();
}

bool WindowView::isOpen()
{
	return !glfwWindowShouldClose(window_.glfwWindow());
}

void WindowView::makePanel()
{
	using namespace nanogui;
	panel_ = new Window(&window_, "semloop-slam");
	panel_->setFixedWidth(kColumn);
	panel_->setLayout(new BoxLayout(Orientation::Vertical, Alignment::Fill, kPadding, kPadding));
	makeButtons(*panel_);

	auto* columns = panel_->add<Widget>();
	columns->setLayout(new BoxLayout(Orientation::Horizontal, Alignment::Minimum, 0, kPadding));
	const auto column = [&](int width)
	{
		auto* label = columns->add<Label>("", "sans", kFontSize);
		label->setFixedWidth(width);
		return label;
	};
	numbers_ = column(210);
	stages_ = column(115);
	stageTimes_ = column(105);
	const auto line = [&](const std::string& text, const std::string& font)
	{
		auto* label = panel_->add<Label>(text, font, kFontSize);
		label->setFixedWidth(kColumn - 2 * kPadding);
		return label;
	};
	line(
		"Blue: the camera's path. Grey: by odometry alone. Orange: matches of the last loop "
		"closure.",
		"sans");
	status_ = line("", "sans-bold");
}

void WindowView::makeButtons(nanogui::Widget& panel)
{
	using namespace nanogui;
	auto* row = panel.add<Widget>();
	row->setLayout(new BoxLayout(Orientation::Horizontal, Alignment::Middle, 0, kPadding));
	pause_ = row->add<Button>("Pause", ENTYPO_ICON_CONTROLLER_PAUS);
	pause_->setFixedWidth(110);
	pause_->setTooltip("Space");
	pause_->setCallback([this] { control_.togglePause(); });
	auto* step = row->add<Button>("Step", ENTYPO_ICON_CONTROLLER_NEXT);
	step->setFixedWidth(90);
	step->setTooltip("One frame: S or right arrow");
	step->setCallback([this] { control_.step(); });
	follow_ = row->add<CheckBox>("follow the camera");
	follow_->setFontSize(kFontSize);
	follow_->setChecked(true);
}

bool WindowView::pressKey(int key, int action)
{
	if (action == GLFW_RELEASE) return false;
	if (key == GLFW_KEY_SPACE && action == GLFW_PRESS)
		control_.togglePause();
	else if (key == GLFW_KEY_S || key == GLFW_KEY_RIGHT)
		control_.step();
	else
		return false;
	return true;
}

void WindowView::show(SlamSnapshot&& snapshot)
{
	somethingNew_ = true;
	const PictureSnapshot& seen = snapshot.picture;
	const cv::Mat image = seen.instances ? drawInstances(*seen.instances, seen.color) : seen.color;
	if (!image.empty())
	{
		picture_->setImageView(mrpt::img::CImage(image, mrpt::img::DEEP_COPY));
		pictureSize_ = image.size();
	}
	scene_->showCamera(seen.camera, snapshot.T_world_camera);
	T_world_camera_ = snapshot.T_world_camera;
	if (snapshot.map)
	{
		framesPerSecond_ = snapshot.map->framesPerSecond;
		showStages(snapshot.map->stages);
	}
	showNumbers(snapshot);
	if (snapshot.map) scene_->showMap(std::move(*snapshot.map));
}

void WindowView::showNumbers(const SlamSnapshot& snapshot)
{
	if (const auto& map = snapshot.map)
	{
		loops_ = mrpt::format(
			"objects: %zu\nloops closed: %zu\n%zu ambiguous, %zu rejected\n",
			map->map.objects().size(), map->loopsAccepted, map->loopsAmbiguous, map->loopsRejected);
		if (map->lastLoopFrame)
			loops_ += mrpt::format(
				"last loop: frame %zu, %zu objects\n", *map->lastLoopFrame, map->lastLoop.size());
	}
	std::string text = mrpt::format("frames: %zu", snapshot.frames);
	if (snapshot.picture.progress > 0)
		text += mrpt::format(" (%.0f %%)", 100 * snapshot.picture.progress);
	text += mrpt::format("\nrate: %.1f per second\n", framesPerSecond_) + loops_;
	text += mrpt::format(
		"not segmented: %zu\nodometry lost: %zu\ndropped: %zu", snapshot.notSegmented,
		snapshot.lost, snapshot.news.dropped);
	numbers_->setCaption(text);
	status_->setCaption(snapshot.news.status);
}

void WindowView::showStages(const std::map<std::string, StageRate>& stages)
{
	std::string names, rates;
	for (const auto& [stage, rate] : stages)
	{
		names += stage + "\n";
		rates += mrpt::format("%.1f ms, %.0f/s\n", rate.milliseconds, rate.perSecond);
	}
	stages_->setCaption(names);
	stageTimes_->setCaption(rates);
}

void WindowView::follow(double seconds)
{
	auto& view = window_.camera();
	const auto axis = T_world_camera_.rotateVector(mrpt::math::TVector3D(0, 0, 1));
	const auto centre = T_world_camera_.translation() + axis * kAhead;
	if (std::hypot(axis.x, axis.y) > kLevel)
	{
		// From behind the camera.
		const double azimuth = mrpt::DEG2RAD(double(view.getAzimuthDegrees()));
		const double turn = mrpt::math::wrapToPi(std::atan2(-axis.y, -axis.x) - azimuth);
		somethingNew_ |= std::abs(turn) > kNoTurn;
		view.setAzimuthDegrees(
			float(mrpt::RAD2DEG(azimuth + turn * (1 - std::exp(-seconds / kTurningTime)))));
	}
	view.setCameraPointing(float(centre.x), float(centre.y), float(centre.z));
	viewedFrom_ = view.cameraParams();
}

void WindowView::noticeUser()
{
	const auto now = window_.camera().cameraParams();
	if (now.cameraAzimuthDeg != viewedFrom_.cameraAzimuthDeg ||
		now.cameraPointingX != viewedFrom_.cameraPointingX ||
		now.cameraPointingY != viewedFrom_.cameraPointingY ||
		now.cameraPointingZ != viewedFrom_.cameraPointingZ)
		follow_->setChecked(false);
	viewedFrom_ = now;
}

void WindowView::arrange()
{
	window_.performLayout();
	const int room = window_.height() - panel_->height() - 3 * kMargin;
	const int height =
		std::max(1, std::min(room, kColumn * pictureSize_.height / pictureSize_.width));
	const std::array<int, 2> layout{window_.height(), height};
	if (layout == arrangedFor_) return;
	arrangedFor_ = layout;
	panel_->setPosition({kMargin, height + 2 * kMargin});
	// A viewport begins at the lower left corner, and counts the screen's pixels.
	const double scale = window_.pixelRatio();
	picture_->setViewportPosition(
		scale * kMargin, scale * (window_.height() - kMargin - height), scale * kColumn,
		scale * height);
	window_.background_scene->getViewport()->setViewportPosition(
		scale * (kColumn + 2 * kMargin), 0.0, -1.0, 1.0);
}

void WindowView::work()
{
	somethingNew_ |= scene_->meshFor(kMeshingTime);
	const auto start = Clock::now();
	if (somethingNew_ || start - drawn_ > kLongestWithoutDrawing) draw();
	const auto waitUntil =
		Clock::now() + std::max<Clock::duration>(kWaiting, kIdlePerDrawing * drawingTime_);
	glfwWaitEventsTimeout(std::chrono::duration<double>(waitUntil - Clock::now()).count());
	// It returns early when the user has done something.
	somethingNew_ |= Clock::now() < waitUntil;
	noticeUser();
}

void WindowView::draw()
{
	const auto start = Clock::now();
	somethingNew_ = false;
	if (follow_->checked()) follow(std::chrono::duration<double>(start - drawn_).count());
	pause_->setCaption(control_.isPaused() ? "Go on" : "Pause");
	pause_->setIcon(
		control_.isPaused() ? ENTYPO_ICON_CONTROLLER_PLAY : ENTYPO_ICON_CONTROLLER_PAUS);
	arrange();
	window_.drawAll();
	drawn_ = Clock::now();
	drawingTime_ = drawn_ - start;
}

}  // namespace semloop
