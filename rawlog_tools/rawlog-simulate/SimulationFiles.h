#pragma once

#include <semloop/observations/RawlogWriter.h>

#include <map>
#include <string>

#include "Simulator.h"

namespace semloop
{
/** The rawlog and its two sidecars, frame by frame. */
class SimulationFiles
{
public:
	/** Throws InputError when they cannot be made. */
	SimulationFiles(const std::string& rawlog, bool embed);

	/** Takes the frame's images. */
	void write(SimulatedFrame& frame);
	/** Gives the files their final names, and writes what is known of the first `frames` frames:
	 *  trajectories, objects with their meshes, attribution. */
	void close(const Simulator& simulator, const FurnitureCatalog& catalog);

private:
	std::string prefix_;
	std::string imagesFolder_;  //!< empty: images in the rawlog
	RawlogWriter rawlog_, trueInstances_, instances_;
	std::size_t frames_ = 0;
	std::map<uint32_t, int> observations_;  //!< frames that show each object
};

}  // namespace semloop
