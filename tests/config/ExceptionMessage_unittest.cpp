#include <gtest/gtest.h>
#include <mrpt/core/exceptions.h>
#include <semloop/config/ExceptionMessage.h>

#include <stdexcept>

using semloop::exceptionMessage;

TEST(ExceptionMessage, IsTheFirstLine)
{
	EXPECT_EQ(exceptionMessage(std::runtime_error("the first\nthe second")), "the first");
	EXPECT_EQ(exceptionMessage(std::runtime_error("")), "");
}

TEST(ExceptionMessage, OfMrptsIsWhatTheBannerAndTheCallStackEnclose)
{
	try
	{
		THROW_EXCEPTION("no such sensor");
	}
	catch (const std::exception& e)
	{
		EXPECT_EQ(exceptionMessage(e), "no such sensor");
		EXPECT_NE(std::string(e.what()), "no such sensor");
	}
	EXPECT_EQ(exceptionMessage(std::runtime_error("== x ==\nMessage:  \nrest")), "== x ==");
}
