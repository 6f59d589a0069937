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
	EXPECT_EQ(
		exceptionMessage(std::runtime_error(
			"Message:  ./libs/x/src/C.cpp:114: [virtual void C::f(int)] no device [0]")),
		"no device [0]");
	EXPECT_EQ(exceptionMessage(std::runtime_error("== x ==\nMessage:  \nrest")), "== x ==");
}

TEST(ExceptionMessage, OfOneThatMrptWrappedIsTheInmost)
{
	const auto wrap = []
	{
		MRPT_START
		throw std::runtime_error("the cable is broken");
		MRPT_END
	};
	try
	{
		MRPT_START
		wrap();
		MRPT_END
	}
	catch (const std::exception& e)
	{
		EXPECT_EQ(exceptionMessage(e), "the cable is broken");
	}
}
