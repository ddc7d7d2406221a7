/// \file
/// Rock and colluvium of a grid as two closed surfaces without a gap between them.
#ifndef TAFONI_VOXEL_VOXEL_SURFACE_HPP
#define TAFONI_VOXEL_VOXEL_SURFACE_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/executor.hpp>
#include <tafoni/geometry/indexed_mesh.hpp>
#include <tafoni/voxel/concepts.hpp>
#include <tafoni/voxel/detail/separate_sheets.hpp>
#include <tafoni/voxel/detail/surface_bricks.hpp>
#include <tafoni/voxel/sparse_grid.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace tafoni {

/// What lies on the outer side of a triangle.
enum class voxel_face : std::uint8_t {
    open,     ///< air
    contact,  ///< colluvium on rock, or rock under colluvium: never seen, a renderer may leave it out
    side      ///< the grid ends here, and its border is not air
};

/// A closed, outward oriented 2-manifold of triangles. Arrays "per triangle" and "per vertex" are parallel to `mesh`.
struct voxel_mesh {
    indexed_mesh mesh{};                      ///< in the user's space
    std::vector<voxel> vertex_voxel{};        ///< per vertex: the solid voxel that it stands for, in turned axes; of
                                              ///< the mesh's own kind but for colluvium's vertices where it thins out on rock
    std::vector<voxel> triangle_voxel{};      ///< per triangle: a voxel of the mesh's own kind beside it, in turned axes
    std::vector<voxel_face> triangle_face{};  ///< per triangle

    friend bool operator==(voxel_mesh const&, voxel_mesh const&) = default;
};

/// Both together close the solid: each `contact` triangle occurs once in either mesh, in opposite orientation and
/// with equal positions.
struct voxel_surface {
    voxel_mesh rock{};
    voxel_mesh colluvium{};

    friend bool operator==(voxel_surface const&, voxel_surface const&) = default;
};

struct voxel_surface_options {
    /// Rounds in which every vertex moves to the mean of itself and its neighbours, 0 .. 1000, on the grid's sides
    /// as well. With 0 vertices stay in the middle between two voxels.
    int smoothing = 1;

    /// \throws invalid_input  bad_parameter
    void validate() const { detail::require_range("voxel_surface_options.smoothing", smoothing, 0, 1000); }
};

namespace detail {

/// A crossed edge of the grid: where it is and what lies at its ends.
struct surface_edge {
    voxel low{};
    std::uint8_t axis = 0;
    std::array<voxel_state, 2> ends{};
    std::uint8_t side = 0;  ///< 1 where it leaves the grid and the border there is not air

    [[nodiscard]] voxel high() const noexcept {
        return {low.x + (axis == 0 ? 1 : 0), low.y + (axis == 1 ? 1 : 0), low.z + (axis == 2 ? 1 : 0)};
    }
    [[nodiscard]] bool has(voxel_state s) const noexcept { return ends[0] == s || ends[1] == s; }
    /// The end of kind `own`, else the solid end.
    [[nodiscard]] voxel stands_for(voxel_state own) const noexcept {
        if (ends[0] == own) return low;
        if (ends[1] == own) return high();
        return ends[0] != voxel_state::air ? low : high();
    }
};

/// Positions of crossed edges' middles in whole numbers, so that sums of them know no order.
class surface_places {
public:
    using place = std::array<std::int64_t, 3>;
    static constexpr std::int64_t unit = std::int64_t{1} << 31;  ///< parts of a voxel's edge

    explicit surface_places(std::span<surface_edge const> edges) : at_(edges.size()) {
        for (std::size_t v = 0; v < edges.size(); ++v) {
            std::array<std::int32_t, 3> const low{edges[v].low.x, edges[v].low.y, edges[v].low.z};
            for (std::size_t d = 0; d < 3; ++d) at_[v][d] = unit * low[d] + (edges[v].axis == d ? unit : unit / 2);
        }
    }

    /// One vertex counts once for itself and once for every neighbour, where two triangles lie at each edge.
    template <executor E>
    void smooth(std::span<std::uint32_t const> rock, std::span<std::uint32_t const> rest, int rounds, E const& exec) {
        if (rounds == 0) return;
        std::vector<place> sum(at_.size());
        std::vector<std::int64_t> weight(at_.size(), 2);
        for (auto const corners : {rock, rest}) {
            for (std::uint32_t const v : corners) weight[v] += 2;
        }
        for (int k = 0; k < rounds; ++k) {
            for (std::size_t v = 0; v < at_.size(); ++v) {
                for (std::size_t d = 0; d < 3; ++d) sum[v][d] = 2 * at_[v][d];
            }
            for (auto const corners : {rock, rest}) {
                for (std::size_t c = 0; c < corners.size(); c += 3) {
                    place const& a = at_[corners[c]];
                    place const& b = at_[corners[c + 1]];
                    place const& e = at_[corners[c + 2]];
                    for (std::size_t d = 0; d < 3; ++d) {
                        sum[corners[c]][d] += b[d] + e[d];
                        sum[corners[c + 1]][d] += a[d] + e[d];
                        sum[corners[c + 2]][d] += a[d] + b[d];
                    }
                }
            }
            exec.for_blocks(at_.size(), 8192, [&](std::size_t begin, std::size_t end) {
                for (std::size_t v = begin; v < end; ++v) {
                    for (std::size_t d = 0; d < 3; ++d) at_[v][d] = nearest(sum[v][d], weight[v]);
                }
            });
        }
    }

    [[nodiscard]] vec3 in_user_space(sparse_grid const& grid, std::size_t v) const noexcept {
        grid_frame const& frame = grid.user_frame();
        up_rotation const& turn = grid.rotation();
        vec3 out;
        for (std::size_t k = 0; k < 3; ++k) {
            auto const a = static_cast<Eigen::Index>(turn.axis[k]);
            std::int64_t const far_side = unit * static_cast<std::int64_t>(grid.size()[k]);
            std::int64_t const u = turn.mirrored[k] ? far_side - at_[v][k] : at_[v][k];
            out[a] = frame.origin[a] + frame.spacing[a] * (static_cast<double>(u) * 0x1p-31);
        }
        return out;
    }

private:
    /// Ties go to the even neighbour, so that a mirrored grid gives mirrored positions.
    static std::int64_t nearest(std::int64_t sum, std::int64_t weight) noexcept {
        std::int64_t q = sum / weight;
        std::int64_t r = sum % weight;
        if (r < 0) {
            r += weight;
            --q;
        }
        return q + (2 * r > weight || (2 * r == weight && (q & 1) != 0) ? 1 : 0);
    }

    std::vector<place> at_;
};

/// The two meshes while their corners still name crossed edges.
template <executor E>
class voxel_surface_builder {
public:
    voxel_surface_builder(sparse_grid const& grid, E const& exec) : grid_(grid), exec_(exec), blocks_(grid, exec) {}

    voxel_surface build(int smoothing) {
        edges_.resize(blocks_.edge_count());
        rock_.resize(3 * blocks_.rock_triangles());
        loose_.resize(3 * blocks_.colluvium_triangles());
        loose_inner_.resize(blocks_.colluvium_triangles());
        out_.rock.triangle_face.resize(blocks_.rock_triangles());
        out_.colluvium.triangle_voxel.resize(blocks_.colluvium_triangles());
        exec_.for_blocks(blocks_.blocks().size(), 4, [&](std::size_t begin, std::size_t end) {
            auto rows = std::make_unique<cell_rows>();
            for (std::size_t b = begin; b < end; ++b) emit(*blocks_.blocks()[b], *rows);
        });

        surface_places places(edges_);
        places.smooth(rock_, open_colluvium(smoothing), smoothing, exec_);
        finish_rock(places);
        finish_colluvium(places);
        return std::move(out_);
    }

private:
    void emit(surface_block const& block, cell_rows& rows) {
        rows.gather(grid_, block.low);
        name_edges(block, rows);
        auto const around = blocks_.around(block);
        std::size_t rock_at = block.triangles[0];
        std::size_t loose_at = block.triangles[1];
        for_boundary_cells(rows, [&](std::size_t x, std::size_t y, int z, unsigned solid, unsigned rock) {
            std::array<std::uint32_t, 12> edge{};
            unsigned left = static_cast<unsigned>(surface_cases[rock].crossed) | surface_cases[solid].crossed;
            for (; left != 0; left &= left - 1) {
                int const e = std::countr_zero(left);
                edge[static_cast<std::size_t>(e)] = surface_blocks::edge(around, x, y, static_cast<std::size_t>(z), e);
            }
            auto const put = [&](std::vector<std::uint32_t>& to, std::size_t t, std::array<std::uint8_t, 3> const& corners) {
                for (std::size_t c = 0; c < 3; ++c) to[3 * t + c] = edge[corners[c]];
            };
            if (solid == rock) {
                for (unsigned t = 0; t < surface_cases[rock].count; ++t) {
                    put(rock_, rock_at, surface_cases[rock].triangles[t]);
                    out_.rock.triangle_face[rock_at++] = voxel_face::open;
                }
                return;
            }
            split_case const cut(solid, rock);
            int const lowest = std::countr_zero(solid & ~rock);
            voxel const beside{block.low.x + static_cast<std::int32_t>(x) + (lowest & 1),
                               block.low.y + static_cast<std::int32_t>(y) + (lowest >> 1 & 1),
                               block.low.z + z + (lowest >> 2 & 1)};
            for (unsigned t = 0; t < cut.rock.count; ++t) {
                auto const& corners = cut.rock.triangles[t];
                bool const open = (cut.rock_shared >> t & 1U) != 0;
                put(rock_, rock_at, corners);
                out_.rock.triangle_face[rock_at++] = open ? voxel_face::open : voxel_face::contact;
                if (open) continue;
                put(loose_, loose_at, {corners[0], corners[2], corners[1]});
                loose_inner_[loose_at] = 1;
                out_.colluvium.triangle_voxel[loose_at++] = beside;
            }
            for (unsigned t = 0; t < cut.solid.count; ++t) {
                if ((cut.solid_shared >> t & 1U) != 0) continue;
                put(loose_, loose_at, cut.solid.triangles[t]);
                loose_inner_[loose_at] = 0;
                out_.colluvium.triangle_voxel[loose_at++] = beside;
            }
        });
    }

    void name_edges(surface_block const& block, cell_rows const& rows) {
        auto const& size = grid_.size();
        auto const& sides = grid_.border().sides;
        for (std::size_t a = 0; a < 3; ++a) {
            std::size_t at = block.first[a];
            for (std::size_t column = 0; column < 1024; ++column) {
                std::size_t const x = column & 31;
                std::size_t const y = column >> 5;
                std::size_t const beside_x = x + (a == 0 ? 1 : 0);
                std::size_t const beside_y = y + (a == 1 ? 1 : 0);
                int const above = a == 2 ? 1 : 0;
                for (std::uint32_t left = block.crossed[column + 1024 * a]; left != 0; left &= left - 1) {
                    int const z = std::countr_zero(left);
                    auto const state = [&](std::size_t i, std::size_t j, int k) {
                        if ((rows.rock(i, j) >> k & 1U) != 0) return voxel_state::rock;
                        return (rows.solid(i, j) >> k & 1U) != 0 ? voxel_state::colluvium : voxel_state::air;
                    };
                    surface_edge& e = edges_[at++];
                    e.low = {block.low.x + static_cast<std::int32_t>(x), block.low.y + static_cast<std::int32_t>(y), block.low.z + z};
                    e.axis = static_cast<std::uint8_t>(a);
                    e.ends = {state(x, y, z), state(beside_x, beside_y, z + above)};
                    std::int32_t const along = a == 0 ? e.low.x : a == 1 ? e.low.y : e.low.z;
                    bool const leaves_low = along < 0 && sides[2 * a] != border_kind::air;
                    bool const leaves_high = along + 1 == static_cast<std::int32_t>(size[a]) && sides[2 * a + 1] != border_kind::air;
                    e.side = leaves_low || leaves_high ? 1 : 0;
                }
            }
        }
    }

    /// Corners of the triangles of colluvium that are not rock's as well.
    std::vector<std::uint32_t> open_colluvium(int smoothing) const {
        std::vector<std::uint32_t> out;
        if (smoothing == 0) return out;
        for (std::size_t c = 0; c < loose_.size(); ++c) {
            if (loose_inner_[c / 3] == 0) out.push_back(loose_[c]);
        }
        return out;
    }

    [[nodiscard]] voxel_face outside(voxel_face face, std::uint32_t const* corners) const {
        bool const side = edges_[corners[0]].side != 0 && edges_[corners[1]].side != 0 && edges_[corners[2]].side != 0;
        return side && face == voxel_face::open ? voxel_face::side : face;
    }

    static void set_triangles(indexed_mesh& mesh, std::vector<std::uint32_t>&& corners) {
        mesh.corners = std::move(corners);
        mesh.offsets.resize(mesh.corners.size() / 3 + 1);
        for (std::size_t t = 0; t < mesh.offsets.size(); ++t) mesh.offsets[t] = 3 * t;
    }

    void finish_rock(surface_places const& places) {
        voxel_mesh& m = out_.rock;
        m.triangle_voxel.resize(m.triangle_face.size());
        std::vector<std::uint32_t> name(edges_.size(), 0);
        std::uint32_t used = 0;
        for (std::size_t v = 0; v < edges_.size(); ++v) {
            name[v] = used;
            used += edges_[v].has(voxel_state::rock) ? 1U : 0U;
        }
        m.mesh.positions.resize(used);
        m.vertex_voxel.resize(used);
        exec_.for_blocks(edges_.size(), 8192, [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) {
                if (!edges_[v].has(voxel_state::rock)) continue;
                m.mesh.positions[name[v]] = places.in_user_space(grid_, v);
                m.vertex_voxel[name[v]] = edges_[v].stands_for(voxel_state::rock);
            }
        });
        exec_.for_blocks(m.triangle_face.size(), 8192, [&](std::size_t begin, std::size_t end) {
            for (std::size_t t = begin; t < end; ++t) {
                m.triangle_face[t] = outside(m.triangle_face[t], rock_.data() + 3 * t);
                m.triangle_voxel[t] = edges_[rock_[3 * t]].stands_for(voxel_state::rock);
                for (std::size_t c = 3 * t; c < 3 * t + 3; ++c) rock_[c] = name[rock_[c]];
            }
        });
        set_triangles(m.mesh, std::move(rock_));
    }

    void finish_colluvium(surface_places const& places) {
        voxel_mesh& m = out_.colluvium;
        if (loose_.empty()) return;
        m.triangle_face.resize(loose_inner_.size());
        for (std::size_t t = 0; t < loose_inner_.size(); ++t) {
            voxel_face const face = loose_inner_[t] != 0 ? voxel_face::contact : voxel_face::open;
            m.triangle_face[t] = outside(face, loose_.data() + 3 * t);
        }
        std::vector<std::uint32_t> name(edges_.size(), strong_index<struct any_tag>::none);
        for (std::uint32_t const c : loose_) name[c] = 0;
        std::vector<std::uint8_t> common;
        std::vector<std::uint32_t> edge_of;
        for (std::size_t v = 0; v < edges_.size(); ++v) {
            if (name[v] != 0) continue;
            name[v] = static_cast<std::uint32_t>(edge_of.size());
            edge_of.push_back(static_cast<std::uint32_t>(v));
            common.push_back(edges_[v].has(voxel_state::rock) && edges_[v].has(voxel_state::air) ? 1 : 0);
        }
        for (std::uint32_t& c : loose_) c = name[c];
        separate_sheets separate;
        auto const doubled = separate(loose_, loose_inner_, common, static_cast<std::uint32_t>(edge_of.size()));
        for (std::uint32_t const v : doubled) edge_of.push_back(edge_of[v]);
        require_indexable("extract_voxel_surface", edge_of.size());
        m.mesh.positions.reserve(edge_of.size());
        m.vertex_voxel.reserve(edge_of.size());
        for (std::uint32_t const v : edge_of) {
            m.mesh.positions.push_back(places.in_user_space(grid_, v));
            m.vertex_voxel.push_back(edges_[v].stands_for(voxel_state::colluvium));
        }
        set_triangles(m.mesh, std::move(loose_));
    }

    sparse_grid const& grid_;
    E const& exec_;
    surface_blocks blocks_;
    std::vector<surface_edge> edges_{};
    std::vector<std::uint32_t> rock_{};
    std::vector<std::uint32_t> loose_{};
    std::vector<std::uint8_t> loose_inner_{};
    voxel_surface out_{};
};

struct extract_voxel_surface_fn {
    /// Marching cubes [Jones et al., section 4.3] between voxels' centres: rock, and what is solid but not rock. Voxels
    /// that meet only across an edge or a corner are separate. Where colluvium thins out on rock or pieces of it
    /// touch, vertices are doubled. Both surfaces are closed at the grid's sides, whatever the border is: there
    /// vertices lie on the side, and triangles before a border that is not air say so. Only bricks with a
    /// boundary are visited. The same bits for every executor. O(bricks + surface (1 + smoothing)).
    /// \throws invalid_input  bad_parameter for options; size_overflow beyond 2^32 - 2 vertices or corners.
    template <executor E = inline_executor>
    [[nodiscard]] voxel_surface operator()(sparse_grid const& grid, voxel_surface_options const& options = {},
                                           E const& exec = {}) const {
        options.validate();
        return voxel_surface_builder<E>(grid, exec).build(options.smoothing);
    }

    /// The same for any grid, by way of a copy; turned axes are the user's. O(voxels).
    template <voxel_grid G, executor E = inline_executor>
    [[nodiscard]] voxel_surface operator()(G const& grid, voxel_surface_options const& options = {}, E const& exec = {}) const {
        return (*this)(sparse_grid::copy_of(grid), options, exec);
    }
};

}  // namespace detail

/// Extracts rock and colluvium; see `detail::extract_voxel_surface_fn`.
inline constexpr detail::extract_voxel_surface_fn extract_voxel_surface{};

}  // namespace tafoni

#endif
