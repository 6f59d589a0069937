#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/core/initializer.h>
#include <semloop/config/Error.h>
#include <semloop/config/ModuleFactory.h>

namespace example
{
class Shape : public mrpt::rtti::CObject
{
	DEFINE_VIRTUAL_MRPT_OBJECT(Shape)
public:
	virtual int corners() const = 0;
};
class Triangle : public Shape
{
	DEFINE_MRPT_OBJECT(Triangle, example)
public:
	int corners() const override { return 3; }
};
class Unrelated : public mrpt::rtti::CObject
{
	DEFINE_MRPT_OBJECT(Unrelated, example)
};
}  // namespace example

IMPLEMENTS_VIRTUAL_MRPT_OBJECT(Shape, mrpt::rtti::CObject, example)
IMPLEMENTS_MRPT_OBJECT(Triangle, Shape, example)
IMPLEMENTS_MRPT_OBJECT(Unrelated, mrpt::rtti::CObject, example)
MRPT_INITIALIZER(registerExamples)
{
	mrpt::rtti::registerClass(CLASS_ID(example::Triangle));
	mrpt::rtti::registerClass(CLASS_ID(example::Unrelated));
}

using namespace semloop;
using testing::HasSubstr;

TEST(ModuleFactory, MakesARegisteredClassByName)
{
	const auto shape = makeModule<example::Shape>("example::Triangle", "x.ini: [modules] shape");
	ASSERT_TRUE(shape);
	EXPECT_EQ(shape->corners(), 3);
}

TEST(ModuleFactory, AnUnknownNameIsAnErrorThatListsTheRegisteredOnes)
{
	try
	{
		makeModule<example::Shape>("example::Circle", "x.ini: [modules] shape");
		FAIL() << "made one";
	}
	catch (const UsageError& e)
	{
		EXPECT_THAT(e.what(), HasSubstr("x.ini: [modules] shape = example::Circle"));
		EXPECT_THAT(e.what(), HasSubstr("example::Triangle"));
		EXPECT_THAT(e.what(), Not(HasSubstr("Unrelated")));
	}
}

TEST(ModuleFactory, AClassOfAnotherKindAndAnAbstractOneAreRefused)
{
	EXPECT_THROW(makeModule<example::Shape>("example::Unrelated", "key"), UsageError);
	EXPECT_THROW(makeModule<example::Shape>("example::Shape", "key"), UsageError);
	EXPECT_THROW(makeModule<example::Shape>("", "key"), UsageError);
}

TEST(ModuleFactory, APluginThatIsNotThereIsNamed)
{
	try
	{
		loadPlugins({"/no/such/plugin.so"}, "x.ini: [modules] plugins");
		FAIL() << "loaded";
	}
	catch (const UsageError& e)
	{
		EXPECT_THAT(e.what(), HasSubstr("/no/such/plugin.so"));
		EXPECT_THAT(std::string(e.what()), Not(HasSubstr("\n")));
	}
}
