/// \file
/// Builds the links graph and the cells graph of a decomposition.
#ifndef TAFONI_GRAPH_MAKE_LINK_GRAPH_HPP
#define TAFONI_GRAPH_MAKE_LINK_GRAPH_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/core/run_context.hpp>
#include <tafoni/decomposition/concepts.hpp>
#include <tafoni/graph/detail/cell_neighborhood.hpp>
#include <tafoni/graph/detail/face_measure.hpp>
#include <tafoni/graph/link_graph.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tafoni {

/// How small a face may be and still carry water.
struct link_graph_options {
    /// Faces of mean width (area / diagonal of the face's box) up to this carry no link, and edges of
    /// length up to this join no neighbours; relative to `model_size()`, in [0, 1e-2].
    double tolerance = 1e-9;

    void validate() const { detail::require_range("link_graph_options.tolerance", tolerance, 0, 1e-2); }
};

namespace detail {

/// The stages of `make_link_graph`, in the order in which they run.
template <class Complex, class Executor>
class link_graph_builder {
public:
    link_graph_builder(Complex const& complex, double limit, Executor const& threads)
        : c_(complex), limit_(limit), threads_(threads) {}

    link_graph build(run_context const& context) {
        require_indexable("make_link_graph: cells", c_.cell_count());
        require_indexable("make_link_graph: sides of faces", 2 * c_.face_count());
        context.tick("links", 0);
        measure_faces();
        context.tick("links", 0.3);
        number_links();
        list_faces_of_cells();
        context.tick("links", 0.4);
        relate_links_of_cells();
        context.tick("links", 0.8);
        join_both_sides();
        context.tick("links", 1);
        return link_graph(std::move(a_));
    }

private:
    static constexpr std::uint32_t none = link_index::none;
    static constexpr std::uint32_t transparent = none - 1;  ///< too small to carry a link
    static constexpr std::uint32_t blocked = none - 2;      ///< artificial skin
    static constexpr std::size_t grain = 256;

    /// Relations inside the cells of one block: lists of neighbours for each (cell, link of the cell).
    struct cell_block {
        std::vector<std::uint32_t> degree{};     ///< links per cell
        std::vector<link_index> links{};
        std::vector<std::uint32_t> neighbors_end{};  ///< per entry of `links`
        std::vector<link_index> neighbors{};
    };

    void measure_faces() {
        std::size_t const n = c_.face_count();
        label_.assign(n, none);
        a_.centroids.resize(n);
        a_.normals.resize(n);
        threads_.for_blocks(n, 4 * grain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t f = begin; f < end; ++f) {
                face_index const face{f};
                face_measure const m = measure_face(c_, face);
                a_.centroids[f] = m.centroid;
                a_.normals[f] = m.area;
                if (c_.face_cells(face)[1].valid()) {
                    if (!(length(m.area) > limit_ * m.diagonal)) label_[f] = transparent;
                } else {
                    label_[f] = blocked;
                }
            }
        });
    }

    /// Interior links in the order of their faces, then the skin by cell and patch.
    void number_links() {
        std::size_t const n = c_.face_count();
        std::size_t interior = 0;
        for (std::size_t f = 0; f < n; ++f) interior += label_[f] == none ? 1U : 0U;
        group_skin(interior);
        a_.cells.reserve(interior);
        for (std::size_t f = 0; f < n; ++f) {
            if (label_[f] != none) {
                if (a_.cells.size() < interior) a_.skipped.push_back(static_cast<std::uint32_t>(f));
                continue;
            }
            std::size_t const l = a_.cells.size();
            auto const cells = c_.face_cells(face_index{f});
            a_.cells.push_back({cells[0].value, cells[1].value});
            a_.centroids[l] = a_.centroids[f];
            a_.normals[l] = a_.normals[f];
            label_[f] = static_cast<std::uint32_t>(l);
        }
        a_.centroids.resize(interior);
        a_.normals.resize(interior);
        a_.centroids.insert(a_.centroids.end(), skin_centroids_.begin(), skin_centroids_.end());
        a_.normals.insert(a_.normals.end(), skin_normals_.begin(), skin_normals_.end());
        a_.centroids.shrink_to_fit();
        a_.normals.shrink_to_fit();
        a_.skipped.shrink_to_fit();
    }

    struct skin_face {
        std::uint32_t cell, patch, face;
        friend auto operator<=>(skin_face const&, skin_face const&) = default;
    };

    void group_skin(std::size_t interior) {
        std::vector<skin_face> skin;
        for (std::size_t f = 0; f < label_.size(); ++f) {
            patch_index const patch = label_[f] == blocked ? c_.face_patch(face_index{f}) : patch_index{};
            if (patch.valid()) {
                skin.push_back({c_.face_cells(face_index{f})[0].value, patch.value, static_cast<std::uint32_t>(f)});
            }
        }
        std::sort(skin.begin(), skin.end());
        for (std::size_t begin = 0; begin < skin.size();) {
            std::size_t end = begin + 1;
            while (end < skin.size() && skin[end].cell == skin[begin].cell && skin[end].patch == skin[begin].patch) ++end;
            add_skin_link({skin.data() + begin, end - begin}, interior);
            begin = end;
        }
        a_.skin_face_order.resize(a_.skin_faces.size());
        for (std::size_t i = 0; i < a_.skin_faces.size(); ++i) a_.skin_face_order[i] = static_cast<std::uint32_t>(i);
        std::sort(a_.skin_face_order.begin(), a_.skin_face_order.end(),
                  [&](std::uint32_t x, std::uint32_t y) { return a_.skin_faces[x] < a_.skin_faces[y]; });
        a_.skin_faces.shrink_to_fit();
    }

    /// One exterior link out of the faces of one cell on one patch, unless they are too small together.
    void add_skin_link(std::span<skin_face const> faces, std::size_t interior) {
        double area = 0;
        double largest = -1;
        vec3 main_normal{0, 0, 0};
        vec3 sum{0, 0, 0};
        box3 box;
        for (skin_face const& s : faces) {
            vec3 const& v = a_.normals[s.face];
            double const size = length(v);
            area += size;
            sum = vec3{sum[0] + v[0], sum[1] + v[1], sum[2] + v[2]};
            if (size > largest) {
                largest = size;
                main_normal = v;
            }
            extend_by_face(c_, face_index{s.face}, box);
        }
        if (!(area > limit_ * box.diagonal())) {
            for (skin_face const& s : faces) label_[s.face] = transparent;
            return;
        }
        vec3 centroid{0, 0, 0};
        for (skin_face const& s : faces) {
            double const w = length(a_.normals[s.face]) / area;
            vec3 const& x = a_.centroids[s.face];
            centroid = vec3{centroid[0] + w * x[0], centroid[1] + w * x[1], centroid[2] + w * x[2]};
            label_[s.face] = static_cast<std::uint32_t>(interior + a_.skin_cells.size());
            a_.skin_faces.push_back(s.face);
        }
        // A patch that closes around its cell has no direction of its own; its largest face gives one.
        vec3 const unit = normalized(length(sum) > 1e-6 * area ? sum : main_normal);
        skin_normals_.push_back(unit);
        skin_centroids_.push_back(centroid);
        a_.skin_areas.push_back(area);
        a_.skin_cells.push_back(faces[0].cell);
        a_.skin_face_begin.push_back(static_cast<std::uint32_t>(a_.skin_faces.size()));
    }

    void list_faces_of_cells() {
        std::size_t const cells = c_.cell_count();
        a_.volumes.resize(cells);
        for (std::size_t c = 0; c < cells; ++c) a_.volumes[c] = c_.cell_volume(cell_index{c});
        face_begin_.assign(cells + 1, 0);
        for_each_side([&](std::uint32_t c, std::uint32_t) { ++face_begin_[c + 1]; });
        for (std::size_t c = 0; c < cells; ++c) face_begin_[c + 1] += face_begin_[c];
        faces_.resize(face_begin_[cells]);
        std::vector<std::uint32_t> next(face_begin_.begin(), face_begin_.end() - 1);
        for_each_side([&](std::uint32_t c, std::uint32_t f) { faces_[next[c]++] = f; });
    }

    template <class Use>
    void for_each_side(Use const& use) const {
        for (std::size_t f = 0; f < label_.size(); ++f) {
            if (label_[f] == blocked) continue;
            auto const cells = c_.face_cells(face_index{f});
            use(cells[0].value, static_cast<std::uint32_t>(f));
            if (cells[1].valid() && cells[1] != cells[0]) use(cells[1].value, static_cast<std::uint32_t>(f));
        }
    }

    void relate_links_of_cells() {
        std::size_t const cells = c_.cell_count();
        blocks_.resize((cells + grain - 1) / grain);
        threads_.for_blocks(cells, grain, [&](std::size_t begin, std::size_t end) {
            // The executor may choose no other blocks than ours, so each writes its own.
            cell_block& out = blocks_[begin / grain];
            cell_neighborhood scratch;
            std::vector<std::uint32_t> nodes;
            for (std::size_t c = begin; c < end; ++c) relate_links_of(c, out, scratch, nodes);
        });
        a_.cell_begin.assign(cells + 1, 0);
        std::size_t c = 0;
        for (cell_block const& b : blocks_) {
            for (std::uint32_t const d : b.degree) {
                a_.cell_begin[c + 1] = a_.cell_begin[c] + d;
                ++c;
            }
        }
        a_.cell_links.reserve(a_.cell_begin[cells]);
        for (cell_block& b : blocks_) {
            a_.cell_links.insert(a_.cell_links.end(), b.links.begin(), b.links.end());
            b.links = {};
            b.degree = {};
        }
    }

    void relate_links_of(std::size_t c, cell_block& out, cell_neighborhood& scratch, std::vector<std::uint32_t>& nodes) {
        std::span<std::uint32_t const> const faces{faces_.data() + face_begin_[c], face_begin_[c + 1] - face_begin_[c]};
        nodes.clear();
        std::size_t small = 0;
        std::size_t edges = 0;
        for (std::uint32_t const f : faces) {
            if (label_[f] == transparent) ++small; else nodes.push_back(label_[f]);
            for (std::size_t l = 0; l < c_.loop_count(face_index{f}); ++l) edges += c_.face_loop(face_index{f}, l).size();
        }
        std::sort(nodes.begin(), nodes.end());
        nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
        scratch.start(nodes.size(), small, edges);
        double const limit = limit_ * limit_;
        auto const is_long = [&](std::uint32_t u, std::uint32_t v) {
            vec3 const a = c_.position(vertex_index{u});
            vec3 const b = c_.position(vertex_index{v});
            return squared_length(vec3{b[0] - a[0], b[1] - a[1], b[2] - a[2]}) > limit;
        };
        auto next_small = static_cast<std::uint32_t>(nodes.size());
        for (std::uint32_t const f : faces) {
            auto const node = label_[f] == transparent
                                  ? next_small++
                                  : static_cast<std::uint32_t>(
                                        std::lower_bound(nodes.begin(), nodes.end(), label_[f]) - nodes.begin());
            for (std::size_t l = 0; l < c_.loop_count(face_index{f}); ++l) {
                auto const loop = c_.face_loop(face_index{f}, l);
                std::uint32_t from = vertex_index{loop[loop.size() - 1]}.value;
                for (std::size_t k = 0; k < loop.size(); ++k) {
                    std::uint32_t const to = vertex_index{loop[k]}.value;
                    scratch.edge(from, to, node, is_long);
                    from = to;
                }
            }
        }
        scratch.close();
        out.degree.push_back(static_cast<std::uint32_t>(nodes.size()));
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            out.links.push_back(link_index{nodes[i]});
            scratch.neighbors_of(static_cast<std::uint32_t>(i),
                                 [&](std::uint32_t j) { out.neighbors.push_back(link_index{nodes[j]}); });
            out.neighbors_end.push_back(static_cast<std::uint32_t>(out.neighbors.size()));
        }
    }

    /// What the link sees inside one of its cells.
    [[nodiscard]] std::span<link_index const> inside(link_index l, std::uint32_t c) const {
        cell_block const& b = blocks_[c / grain];
        auto const first = a_.cell_links.begin() + a_.cell_begin[c];
        auto const last = a_.cell_links.begin() + a_.cell_begin[c + 1];
        auto const at = std::lower_bound(first, last, l);
        auto const slot = static_cast<std::size_t>(at - a_.cell_links.begin()) - a_.cell_begin[c / grain * grain];
        std::size_t const begin = slot == 0 ? 0 : b.neighbors_end[slot - 1];
        return {b.neighbors.data() + begin, b.neighbors_end[slot] - begin};
    }

    /// Appends the union of what a link sees in both of its cells, ascending.
    void unite(std::size_t l, std::vector<link_index>& out) const {
        std::size_t const interior = a_.cells.size();
        link_index const link{l};
        std::uint32_t const front = l < interior ? a_.cells[l][0] : a_.skin_cells[l - interior];
        std::span<link_index const> const a = inside(link, front);
        std::span<link_index const> b;
        if (l < interior && a_.cells[l][1] != front) b = inside(link, a_.cells[l][1]);
        std::size_t const before = out.size();
        out.resize(before + a.size() + b.size());
        link_index* to = out.data() + before;
        std::size_t i = 0;
        std::size_t j = 0;
        while (i < a.size() && j < b.size()) {
            std::uint32_t const x = a[i].value;
            std::uint32_t const y = b[j].value;
            *to++ = link_index{x < y ? x : y};
            i += x <= y ? 1U : 0U;
            j += y <= x ? 1U : 0U;
        }
        to = std::copy(a.begin() + static_cast<std::ptrdiff_t>(i), a.end(), to);
        to = std::copy(b.begin() + static_cast<std::ptrdiff_t>(j), b.end(), to);
        out.resize(static_cast<std::size_t>(to - out.data()));
    }

    void join_both_sides() {
        std::size_t const links = a_.centroids.size();
        std::size_t const step = 4 * grain;
        std::vector<std::vector<link_index>> joined((links + step - 1) / step);
        a_.neighbor_begin.assign(links + 1, 0);
        threads_.for_blocks(links, step, [&](std::size_t first, std::size_t last) {
            std::vector<link_index>& out = joined[first / step];
            out.reserve(16 * (last - first));
            for (std::size_t l = first; l < last; ++l) {
                unite(l, out);
                a_.neighbor_begin[l + 1] = static_cast<std::uint32_t>(out.size());
            }
        });
        blocks_ = {};
        std::size_t total = 0;
        for (auto const& block : joined) total += block.size();
        require_indexable("make_link_graph: pairs of neighbours", total);
        a_.neighbors.reserve(total);
        for (std::size_t b = 0; b < joined.size(); ++b) {
            auto const before = static_cast<std::uint32_t>(a_.neighbors.size());
            for (std::size_t l = b * step; l < std::min((b + 1) * step, links); ++l) a_.neighbor_begin[l + 1] += before;
            a_.neighbors.insert(a_.neighbors.end(), joined[b].begin(), joined[b].end());
            joined[b] = {};
        }
    }

    Complex const& c_;
    double limit_;
    Executor const& threads_;
    link_graph_arrays a_{};
    std::vector<std::uint32_t> label_{};       ///< face -> link, `transparent` or `blocked`
    std::vector<vec3> skin_centroids_{};
    std::vector<vec3> skin_normals_{};
    std::vector<std::uint32_t> face_begin_{};  ///< cell -> faces_
    std::vector<std::uint32_t> faces_{};
    std::vector<cell_block> blocks_{};
};

struct make_link_graph_fn {
    /// Links and their neighbourhood [Mateos et al., section 4.2].
    ///
    /// One interior link per interior face that is large enough; one exterior link per cell and
    /// smooth patch; artificial skin carries none. Neigh(l) holds the links of faces that share an
    /// edge with a face of l in one of the cells; faces that are too small pass neighbours on to
    /// their far sides, so that a lattice whose ties were broken by slivers has proper neighbours.
    /// Same bits for every executor. O(corners), with O(corners) scratch memory.
    /// \throws invalid_input  `bad_parameter`, `size_overflow`; `cancelled` by the observer.
    template <cell_complex Complex, executor Executor = inline_executor>
    [[nodiscard]] link_graph operator()(Complex const& complex, link_graph_options const& options = {},
                                        Executor const& threads = {}, run_context const& context = {}) const {
        options.validate();
        double const limit = options.tolerance * complex.model_size();
        return link_graph_builder<Complex, Executor>(complex, limit, threads).build(context);
    }
};

}  // namespace detail

/// `make_link_graph(complex, options, executor, context)`.
inline constexpr detail::make_link_graph_fn make_link_graph{};

}  // namespace tafoni

#endif
