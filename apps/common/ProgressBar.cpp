#include "ProgressBar.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace semloop
{
namespace
{
double seconds(std::chrono::steady_clock::duration d)
{
	return std::chrono::duration<double>(d).count();
}
}  // namespace

ProgressBar::ProgressBar(std::string what)
	: what_(std::move(what)),
	  terminal_(isatty(STDERR_FILENO)),
	  start_(Clock::now()),
	  lastDraw_(start_)
{
}

ProgressBar::~ProgressBar()
{
	clear();
}

std::optional<double> ProgressBar::dueAfter()
{
	const auto now = Clock::now();
	const double elapsed = seconds(now - start_);
	if (!terminal_ || elapsed < 2.0 || seconds(now - lastDraw_) < 0.2) return std::nullopt;
	lastDraw_ = now;
	drawn_ = true;
	return elapsed;
}

void ProgressBar::updateEndless(std::size_t items, const std::string& note)
{
	const auto elapsed = dueAfter();
	if (!elapsed) return;
	std::fprintf(
		stderr, "\r%s %zu, %.1f/s%s \033[K", what_.c_str(), items, double(items) / *elapsed,
		note.c_str());
}

void ProgressBar::update(std::size_t items, double share)
{
	const auto elapsed = dueAfter();
	if (!elapsed) return;
	constexpr int kWidth = 30;
	share = std::clamp(share, 0.0, 1.0);
	const std::string bar(std::size_t(share * kWidth), '#');
	const double left = share > 0 ? *elapsed * (1 - share) / share : 0;
	std::fprintf(
		stderr, "\r%s [%-*s] %3.0f %%  %zu, %.1f/s, %d:%02d left \033[K", what_.c_str(), kWidth,
		bar.c_str(), 100 * share, items, double(items) / *elapsed, int(left) / 60, int(left) % 60);
}

void ProgressBar::clear()
{
	if (drawn_) std::fprintf(stderr, "\r\033[K");
	drawn_ = false;
}

}  // namespace semloop
