#pragma once

namespace semloop
{
/** Opens and closes the window system's library. */
class GlfwSession
{
public:
	/** Throws std::runtime_error when there is no display. */
	GlfwSession();
	~GlfwSession();
	GlfwSession(const GlfwSession&) = delete;
	GlfwSession& operator=(const GlfwSession&) = delete;
};

}  // namespace semloop
