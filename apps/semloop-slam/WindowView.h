#pragma once

#include <mrpt/gui/CDisplayWindowGUI.h>

#include <array>
#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include "GlfwSession.h"
#include "MapScene.h"
#include "RunControl.h"
#include "SlamSnapshot.h"

namespace semloop
{
/** The window: at the left the camera's picture and, below it, numbers and buttons; at the right the
 *  map. To be made, used and destroyed in one thread; only one at a time. */
class WindowView
{
public:
	/** Throws std::runtime_error when it cannot be opened; onLost as in GlfwSession. */
	WindowView(const std::string& title, RunControl& control, std::function<void()> onLost);

	/** False once the user has closed it. */
	bool isOpen();
	void show(SlamSnapshot&& snapshot);
	/** Draws what is new, and waits a little for what the user does. */
	void work();

private:
	using Clock = std::chrono::steady_clock;

	void makePanel();
	void makeButtons(nanogui::Widget& panel);
	bool pressKey(int key, int action);
	void showNumbers(const SlamSnapshot& snapshot);
	void showStages(const std::map<std::string, StageRate>& stages);
	/** Moves the view with the camera, by so much time. */
	void follow(double seconds);
	void noticeUser();
	/** Puts everything at its place when the window's or the picture's size has changed. */
	void arrange();
	void draw();

	GlfwSession glfw_;
	RunControl& control_;
	mrpt::gui::CDisplayWindowGUI window_;
	mrpt::opengl::COpenGLViewport::Ptr picture_;
	std::optional<MapScene> scene_;

	nanogui::Window* panel_ = nullptr;
	nanogui::Label *numbers_ = nullptr, *stages_ = nullptr, *stageTimes_ = nullptr,
				   *status_ = nullptr;
	nanogui::Button* pause_ = nullptr;
	nanogui::CheckBox* follow_ = nullptr;

	cv::Size pictureSize_{4, 3};
	std::array<int, 2> arrangedFor_{};  //!< heights of window and picture
	double framesPerSecond_ = 0.0;
	std::string loops_;
	mrpt::poses::CPose3D T_world_camera_;
	mrpt::gui::CGlCanvasBase::CamaraParams viewedFrom_;  //!< as follow() left it
	bool somethingNew_ = true;
	Clock::time_point drawn_ = Clock::now();
	Clock::duration drawingTime_{0};
};

}  // namespace semloop
