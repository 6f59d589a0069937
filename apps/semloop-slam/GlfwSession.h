#pragma once

#include <functional>

namespace semloop
{
/** Opens and closes the window system's library. */
class GlfwSession
{
public:
	/** Throws std::runtime_error when there is no display.
	 *
	 *  When the connection to it breaks, Xlib ends the process. We tell onLost instead, and the thread that
	 *  found out, which must be this one, never comes back. */
	explicit GlfwSession(std::function<void()> onLost);
	~GlfwSession();
	GlfwSession(const GlfwSession&) = delete;
	GlfwSession& operator=(const GlfwSession&) = delete;
};

}  // namespace semloop
