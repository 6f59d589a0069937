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
	thread_.join();
}

void SlamWindow::run(const std::string& title, std::promise<void> opened)
{
	try
	{
		WindowView view(title, control_);
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
