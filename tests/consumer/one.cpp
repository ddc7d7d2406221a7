#include <tafoni/fwd.hpp>
#include <tafoni/tafoni.hpp>

std::uint64_t blocks_of_the_other_unit();

int main() {
    tafoni::indexed_mesh mesh = tafoni::make_outcrop(1, 8);
    tafoni::solid const rock = tafoni::make_solid(mesh);
    tafoni::shard_complex const shards = tafoni::voronoi_shards(rock, tafoni::random_sites{.count = 50}(rock, 1));
    tafoni::link_graph const links = tafoni::make_link_graph(shards);
    tafoni::frost_run run(links);
    auto const report = run.run({.paths = 100});
    std::vector<std::uint8_t> const all(shards.cell_count(), 1);
    tafoni::shard_surface const surface = tafoni::extract_surface(shards, all);
    bool const complete = report.paths == 100 && surface.mesh.face_count() > mesh.face_count();
    return complete && blocks_of_the_other_unit() < 1000 ? 0 : 1;
}
