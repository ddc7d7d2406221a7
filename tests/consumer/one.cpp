#include <tafoni/fwd.hpp>
#include <tafoni/tafoni.hpp>

int other_unit();

int main() {
    tafoni::indexed_mesh mesh;
    mesh.add_vertex(tafoni::vec3{0, 0, 0});
    return mesh.vertex_count() == 1 && other_unit() == tafoni::version_major ? 0 : 1;
}
