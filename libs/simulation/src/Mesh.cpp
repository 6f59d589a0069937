#include <semloop/config/Error.h>
#include <semloop/simulation/Mesh.h>

namespace semloop
{
Bounds boundsOf(const Mesh& mesh)
{
	if (mesh.vertices.empty()) throw InputError("a mesh without vertices has no size");
	Bounds bounds{mesh.vertices.front(), mesh.vertices.front()};
	for (const Eigen::Vector3f& vertex : mesh.vertices)
	{
		bounds.minimum = bounds.minimum.cwiseMin(vertex);
		bounds.maximum = bounds.maximum.cwiseMax(vertex);
	}
	return bounds;
}

}  // namespace semloop
