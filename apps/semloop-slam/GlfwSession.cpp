#include "GlfwSession.h"

#include <GLFW/glfw3.h>
#include <X11/Xlib.h>
#include <unistd.h>

#include <stdexcept>
#include <utility>

namespace semloop
{
namespace
{
// Xlib's handler is a plain function, and there is one session at a time.
std::function<void()> tellLost;

int stay(Display*)
{
	tellLost();
	while (true) pause();
}
}  // namespace

GlfwSession::GlfwSession(std::function<void()> onLost)
{
	if (glfwInit() != GLFW_TRUE)
	{
		const char* description = nullptr;
		glfwGetError(&description);
		throw std::runtime_error(description ? description : "GLFW does not start");
	}
	tellLost = std::move(onLost);
	XSetIOErrorHandler(stay);
}

GlfwSession::~GlfwSession()
{
	glfwTerminate();
	XSetIOErrorHandler(nullptr);
}

}  // namespace semloop
