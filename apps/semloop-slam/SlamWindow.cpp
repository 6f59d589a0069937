#include "SlamWindow.h"

#include <semloop/config/Error.h>

#include <iostream>
#include <utility>

#include "WindowView.h"

namespace semloop
{
SlamWindow::SlamWindow(const std::string& title)
{
	std::promise<void> opened;
	auto isOpened = opened.get_future();
	thread_ = std::thread(&SlamWindow::run, this, title, std::move(opened));
	try
	{
		isOpened.get();
	}
	catch (const std::exception& e)
	{
		thread_.join();
		throw InputError(
			std::string("--gui: no window can be opened (") + e.what() +
			"); run it on a desktop, or without --gui");
	}
}

SlamWindow::~SlamWindow()
{
	leave_ = true;
	std::unique_lock lock(mutex_);
	left_.wait(lock, [&] { return hasLeft_ || isLost_; });
	lock.unlock();
	if (isLost_)
		thread_.detach();  // it stays where Xlib found out, for ever
	else
		thread_.join();
}

void SlamWindow::noteLost()
{
	std::cerr << "semloop-slam: warning: the display is gone; the run goes on without window\n";
	open_ = false;
	control_.release();
	const std::lock_guard lock(mutex_);
	isLost_ = true;
	left_.notify_all();
}

void SlamWindow::run(const std::string& title, std::promise<void> opened)
{
	try
	{
		WindowView view(title, control_, [this] { noteLost(); });
		open_ = true;
		opened.set_value();
		while (!leave_ && view.isOpen())
		{
			if (auto news = takeNews()) view.show(std::move(*news));
			view.work();
		}
	}
	catch (const std::exception& e)
	{
		if (open_)
			std::cerr << "semloop-slam: warning: the window is closed: " << e.what() << "\n";
		else
			opened.set_exception(std::current_exception());
	}
	open_ = false;
	control_.release();
	const std::lock_guard lock(mutex_);
	hasLeft_ = true;
	left_.notify_all();
}

void SlamWindow::show(
	const SlamFrame* frame, const SemanticSlam& slam, const StageTimings& timings,
	const WindowNews& news)
{
	if (!open_) return;
	// What is looked at while the run stands still is to be complete.
	auto snapshot = taker_.take(frame, slam, timings, news, control_.isPaused());
	const std::lock_guard lock(mutex_);
	if (news_ && news_->map && !snapshot.map) snapshot.map = std::move(news_->map);
	news_ = std::move(snapshot);
}

std::optional<SlamSnapshot> SlamWindow::takeNews()
{
	const std::lock_guard lock(mutex_);
	return std::exchange(news_, std::nullopt);
}

}  // namespace semloop
