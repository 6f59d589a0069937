#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>

namespace semloop
{
/** A line on stderr with share done, rate and time left, redrawn a few times a second; shows nothing
 *  when stderr is not a terminal or the work takes less than two seconds. */
class ProgressBar
{
public:
	explicit ProgressBar(std::string what);
	~ProgressBar();

	/** Items done so far and the share of the whole, in [0, 1]. */
	void update(std::size_t items, double share);
	/** Same for work without an end in sight; the note comes behind the rate. */
	void updateEndless(std::size_t items, const std::string& note);
	/** Wipes the line, so that a message can be printed. */
	void clear();

private:
	using Clock = std::chrono::steady_clock;

	/** Seconds since the start when it is time to draw again. */
	std::optional<double> dueAfter();

	std::string what_;
	bool terminal_ = false;
	bool drawn_ = false;
	Clock::time_point start_;
	Clock::time_point lastDraw_;
};

}  // namespace semloop
