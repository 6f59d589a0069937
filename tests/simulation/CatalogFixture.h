#pragma once

#include <semloop/simulation/FurnitureCatalog.h>

#include <map>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "TemporaryFolder.h"
#include "ZipFile.h"

namespace semloop
{
/** A folder with one small catalogue, Test.sh3f, whose one model, Test#chair, is a seat (y up) with a
 *  backrest at its back, z = -2. Change `files` and `model` before opening. */
struct CatalogFixture
{
	std::map<std::string, std::string> model = {
		{"id", "Test#chair"}, {"name", "Chair"}, {"model", "/test/chair/chair.obj"},
		{"width", "40"},      {"depth", "50.0"}, {"height", "90"}};
	std::map<std::string, std::string> files = {{"test/chair/chair.obj", kChair}};
	std::string header = "license=Free  for \xa9 all \n";
	TemporaryFolder folder;

	static constexpr const char* kChair =
		"v -1 0 2\nv 1 0 2\nv 1 0 -2\nv -1 0 -2\n"
		"v 1 3 -2\nv -1 3 -2\n"
		"vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
		"f 1/1 2/2 3/3 4/4\n"
		"f 4/1 3/2 5/3 6/4\n";

	FurnitureCatalog open()
	{
		std::string properties = "# a catalogue\n" + header;
		for (const auto& [key, value] : model) properties += key + "#1=" + value + "\n";
		files["PluginFurnitureCatalog.properties"] = properties;
		writeZip(archive(), files);
		return FurnitureCatalog::open(folder.path().string());
	}
	Mesh load()
	{
		const FurnitureCatalog catalog = open();
		return catalog.load(catalog.entry(model["id"]));
	}
	/** Gives the model a material with the text of an .mtl. */
	void setMaterial(const std::string& mtl)
	{
		files["test/chair/chair.obj"] = std::string("mtllib chair.mtl\nusemtl paint\n") + kChair;
		files["test/chair/chair.mtl"] = "newmtl paint\n" + mtl;
	}
	std::string archive() const { return folder.file("Test.sh3f"); }
};

/** Bytes of a PNG image of one colour. */
inline std::string png(int width, int height, const cv::Scalar& bgr)
{
	std::vector<uchar> bytes;
	cv::imencode(".png", cv::Mat(height, width, CV_8UC3, bgr), bytes);
	return {bytes.begin(), bytes.end()};
}

}  // namespace semloop
