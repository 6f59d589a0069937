#include <semloop/object_map/MeshVisualization.h>

#include <vector>

namespace semloop
{
mrpt::opengl::CSetOfTriangles::Ptr trianglesOf(const TriangleMesh& mesh)
{
	auto triangles = mrpt::opengl::CSetOfTriangles::Create();
	std::vector<mrpt::opengl::TTriangle> all;
	all.reserve(mesh.triangles.size());
	for (const auto& corners : mesh.triangles)
	{
		mrpt::opengl::TTriangle triangle;
		for (std::size_t i = 0; i < 3; ++i)
		{
			const SurfacePoint& vertex = mesh.vertices[corners[i]];
			triangle.vertices[i].xyzrgba.pt = vertex.position;
			triangle.vertices[i].normal = vertex.normal;
			triangle.vertices[i].setColor(vertex.color);
		}
		all.push_back(triangle);
	}
	triangles->insertTriangles(all.begin(), all.end());
	return triangles;
}

}  // namespace semloop
