#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/observations/LabelSet.h>

#include "TemporaryFolder.h"

using semloop::InputError;
using semloop::LabelSet;

TEST(LabelSet, CocoHasItsEightyClassesInTheOrderOfTheDetectionTask)
{
	const LabelSet coco = LabelSet::coco();
	ASSERT_EQ(coco.size(), 80u);
	EXPECT_EQ(coco.name(0), "person");
	EXPECT_EQ(coco.name(39), "bottle");
	EXPECT_EQ(coco.name(56), "chair");
	EXPECT_EQ(coco.name(62), "tv");
	EXPECT_EQ(coco.name(66), "keyboard");
	EXPECT_EQ(coco.name(73), "book");
	EXPECT_EQ(coco.name(79), "toothbrush");
	EXPECT_EQ(coco.find("laptop"), 63u);
}

TEST(LabelSet, FindsNothingForANameItDoesNotHave)
{
	EXPECT_EQ(LabelSet::coco().find("monitor"), std::nullopt);
	EXPECT_EQ(LabelSet().find(""), std::nullopt);
	EXPECT_THROW(LabelSet::coco().name(80), std::out_of_range);
}

TEST(LabelSet, RefusesEmptyAndRepeatedNames)
{
	EXPECT_THROW(LabelSet({"cup", ""}), InputError);
	EXPECT_THROW(LabelSet({"cup", "book", "cup"}), InputError);
}

TEST(LabelSet, ReadsANamePerLineAndPassesOverCommentsAndBlanks)
{
	const semloop::TemporaryFolder folder;
	const auto path = folder.write("names.txt", "# mine\ncup\r\n\n  potted plant \nbook");
	EXPECT_EQ(
		LabelSet::fromFile(path).names(),
		(std::vector<std::string>{"cup", "potted plant", "book"}));
}

TEST(LabelSet, NamesTheFileThatCannotBeUsed)
{
	const semloop::TemporaryFolder folder;
	for (const auto& path :
		 {folder.file("missing.txt"), folder.write("empty.txt", "# nothing\n"),
		  folder.write("twice.txt", "cup\ncup\n")})
	{
		const auto message = semloop::messageOf<InputError>([&] { LabelSet::fromFile(path); });
		EXPECT_EQ(message.find(path), 0u) << message;
	}
}
