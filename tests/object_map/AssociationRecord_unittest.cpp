#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/object_map/AssociationRecord.h>

#include "TemporaryFolder.h"

using namespace semloop;
using testing::HasSubstr;

TEST(AssociationRecord, IsALineWithMicrosecondsUnderTheHeading)
{
	AssociationRecord record;
	record.time = mrpt::Clock::fromDouble(1305031453.25);
	record.frame = 7;
	record.instance = 2;
	record.box = {10, 20, 30, 40};
	record.object = 3;
	record.firstObject = 5;
	EXPECT_EQ(
		associationsAsCsv({record}),
		"time,frame,instance,x,y,w,h,object,first_object\n"
		"1305031453.250000,7,2,10,20,30,40,3,5\n");
}

TEST(AssociationRecord, NoneLeaveTheHeading)
{
	EXPECT_EQ(associationsAsCsv({}), "time,frame,instance,x,y,w,h,object,first_object\n");
}

TEST(AssociationRecord, IsReadAsItWasWritten)
{
	const TemporaryFolder folder;
	const std::string text =
		"time,frame,instance,x,y,w,h,object,first_object\n"
		"1305031453.250000,7,2,10,20,30,40,3,5\n"
		"1305031454.000001,8,0,0,0,1,1,18446744073709551615,5\n";
	const auto records = readAssociations(folder.write("a.csv", text));
	ASSERT_EQ(records.size(), 2u);
	EXPECT_EQ(records[0].box, cv::Rect(10, 20, 30, 40));
	EXPECT_EQ(records[0].firstObject, 5u);
	EXPECT_EQ(associationsAsCsv(records), text);
}

TEST(AssociationRecord, AFileThatIsMissingForeignOrDamagedIsNamedWithTheLine)
{
	const TemporaryFolder folder;
	const auto errorOf = [&](const std::string& text)
	{ return messageOf<InputError>([&] { readAssociations(folder.write("a.csv", text)); }); };
	const std::string heading = "time,frame,instance,x,y,w,h,object,first_object\n";
	EXPECT_THAT(
		messageOf<InputError>([&] { readAssociations(folder.file("none.csv")); }),
		HasSubstr("none.csv: cannot be read"));
	EXPECT_THAT(errorOf(""), HasSubstr("a.csv:1"));
	EXPECT_THAT(errorOf("stage,count\n"), HasSubstr("a.csv:1"));
	EXPECT_THAT(errorOf(heading + "1.0,7,2,10,20,30,40,3\n"), HasSubstr("a.csv:2"));
	EXPECT_THAT(errorOf(heading + "1.0,7,2,10,20,30,40,3,x\n"), HasSubstr("a.csv:2"));
	EXPECT_THAT(errorOf(heading + "1.0,-7,2,10,20,30,40,3,5\n"), HasSubstr("a.csv:2"));
}
