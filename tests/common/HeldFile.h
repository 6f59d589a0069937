#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>

#include "ChildProcess.h"

namespace semloop
{
/** A file (a FIFO) at which a program that reads it stops until the test lets it go on: the test knows
 *  where the program is without looking at the clock. */
class HeldFile
{
public:
	HeldFile(std::string path, std::string content)
		: path_(std::move(path)), content_(std::move(content))
	{
		if (mkfifo(path_.c_str(), 0600) != 0) throw std::runtime_error("cannot make " + path_);
	}
	~HeldFile()
	{
		if (writer_ >= 0) close(writer_);
	}
	HeldFile(const HeldFile&) = delete;
	HeldFile& operator=(const HeldFile&) = delete;

	/** Waits until the program has come to this file. */
	void waitForReader(ChildProcess& program)
	{
		waitUntil(
			"the program reads " + path_,
			[&]
			{
				if (!program.isRunning()) throw std::runtime_error("the program ended too early");
				writer_ = open(path_.c_str(), O_WRONLY | O_NONBLOCK);
				return writer_ >= 0;
			});
		fcntl(writer_, F_SETFL, 0);  // from here on writing may wait
	}
	/** Gives the program the content; whoever reads the file again finds a plain one. */
	void release()
	{
		makePlain();
		for (std::size_t done = 0; done < content_.size();)
		{
			const auto written = write(writer_, &content_[done], content_.size() - done);
			if (written < 0) throw std::runtime_error("cannot write " + path_);
			done += std::size_t(written);
		}
		close(writer_);
		writer_ = -1;
	}
	/** From now on the file is a plain one for who opens it. */
	void makePlain() const
	{
		const std::string plain = path_ + ".plain";
		std::ofstream(plain, std::ios::binary) << content_;
		std::rename(plain.c_str(), path_.c_str());
	}

private:
	std::string path_, content_;
	int writer_ = -1;
};

}  // namespace semloop
