#include "GlfwSession.h"

#include <GLFW/glfw3.h>

#include <stdexcept>

namespace semloop
{
GlfwSession::GlfwSession()
{
	if (glfwInit() == GLFW_TRUE) return;
	const char* description = nullptr;
	glfwGetError(&description);
	throw std::runtime_error(description ? description : "GLFW does not start");
}

GlfwSession::~GlfwSession()
{
	glfwTerminate();
}

}  // namespace semloop
