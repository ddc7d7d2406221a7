// Cells of one's own: a brick wall in running bond. Checked against the laws, weathered by driving rain, written.
#include <tafoni/graph/make_link_graph.hpp>
#include <tafoni/io/weathered_channels.hpp>
#include <tafoni/io/write_ply.hpp>
#include <tafoni/testing/laws.hpp>
#include <tafoni/weathering/frost_run.hpp>

#include <cstdio>

using namespace tafoni;

// The wall is a grid of half bricks; two that lie side by side are one brick, shifted by a half in every other row.
// Faces are those between half bricks, so a brick's upper side has one for each brick that rests on it.
struct brick_wall {
    static constexpr int length = 40, rows = 24;
    static constexpr double width = 0.12, height = 0.07;  // of a half brick, metres
    struct face { std::array<cell_index, 2> cells; std::array<vertex_index, 4> loop; patch_index patch; };
    std::vector<face> faces;
    std::vector<vec3> centroids;
    std::vector<double> halves;

    static bool inside(std::array<int, 3> p) { return p[0] >= 0 && p[0] < length && p[1] == 0 && p[2] >= 0 && p[2] < rows; }
    static std::size_t brick(std::array<int, 3> p) {  // odd rows have a half at either end
        return static_cast<std::size_t>(p[2] * length / 2 + p[2] / 2 + (p[0] + p[2] % 2) / 2);
    }
    brick_wall() : centroids(brick({length - 1, 0, rows - 1}) + 1, vec3{0, 0, 0}), halves(centroids.size()) {
        for (int k = 0; k < length * rows; ++k) add({k % length, 0, k / length});
        for (std::size_t c = 0; c < halves.size(); ++c) centroids[c] /= halves[c];
    }
    void add(std::array<int, 3> const& at) {
        cell_index const here{brick(at)};
        halves[here.value] += 1;
        centroids[here.value] += vec3{(at[0] + 0.5) * width, 0.5 * width, (at[2] + 0.5) * height};
        for (std::size_t side = 0; side < 6; ++side) {
            std::size_t const axis = side / 2;
            auto next = at;
            next[axis] += side % 2 == 1 ? 1 : -1;
            cell_index const there = inside(next) ? cell_index{brick(next)} : cell_index{};
            if (there.valid() && there.value <= here.value) continue;  // the same brick, or listed from there
            face f{.cells = {here, there}, .loop = {}, .patch = {}};
            if (!there.valid() && side != 4) f.patch = patch_index{side};  // side 4, the ground, takes no water
            for (std::size_t k = 0; k < 4; ++k) {                          // counter-clockwise from outside `here`
                auto corner = at;
                std::size_t const turn = side % 2 == 1 ? k : 3 - k;
                corner[axis] += side % 2 == 1 ? 1 : 0;
                corner[(axis + 1) % 3] += turn == 1 || turn == 2 ? 1 : 0;
                corner[(axis + 2) % 3] += turn >= 2 ? 1 : 0;
                f.loop[k] = vertex_index{static_cast<std::uint32_t>(corner[0] + (length + 1) * (corner[1] + 2 * corner[2]))};
            }
            faces.push_back(f);
        }
    }
    std::size_t cell_count() const { return halves.size(); }
    double cell_volume(cell_index c) const { return halves[c.value] * width * width * height; }
    vec3 cell_centroid(cell_index c) const { return centroids[c.value]; }
    std::size_t vertex_count() const { return (length + 1) * 2 * (rows + 1); }
    vec3 position(vertex_index v) const {
        return vec3{width * (v.value % (length + 1)), width * (v.value / (length + 1) % 2), height * (v.value / (2 * (length + 1)))};
    }
    std::size_t face_count() const { return faces.size(); }
    std::array<cell_index, 2> face_cells(face_index f) const { return faces[f.value].cells; }
    std::size_t loop_count(face_index) const { return 1; }
    std::array<vertex_index, 4> face_loop(face_index f, std::size_t) const { return faces[f.value].loop; }
    patch_index face_patch(face_index f) const { return faces[f.value].patch; }
    double model_size() const { return width * length; }
};

int main() {
    brick_wall const wall;
    for (auto const& broken : laws::complex(wall)) return std::printf("broken law: %s\n", broken.c_str()), 1;
    link_graph const links = make_link_graph(wall);
    frost_run run(links, frost_wedging{.rain = directional_rain{.direction = {0, 0.6, -0.8}}}, {.seed = 1});
    for (std::size_t c = 0; c < brick_wall::length / 2; ++c) run.mark(cell_index{c}, cell_state::core);  // the lowest row
    frost_report const report = run.run({.paths = 4'000});
    std::printf("%llu of %zu bricks fell\n", static_cast<unsigned long long>(report.cells_detached), wall.cell_count());
    weathered_surface const left = extract_weathered_surface(wall, run);
    write_ply("wall.ply", left.surface.mesh, channels_of(left));
    return report.cells_detached > 0 ? 0 : 1;
}
