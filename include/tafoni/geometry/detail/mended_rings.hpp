/// \file
/// Rings of a surface while a few of its edges are collapsed.
#ifndef TAFONI_GEOMETRY_DETAIL_MENDED_RINGS_HPP
#define TAFONI_GEOMETRY_DETAIL_MENDED_RINGS_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/geometry/vertex_rings.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <vector>

namespace tafoni::detail {

/// A vertex that became another.
struct merged_vertex {
    std::uint32_t kept = 0;
    std::uint32_t gone = 0;
};

/// Those that `vertex_rings` would find, at the cost of the vertices around what was collapsed; read like them. In the old
/// numbers, where vertices that are gone have no ring, until `renumber`.
class mended_rings {
public:
    using corner = vertex_rings::corner;

    mended_rings() = default;
    /// `base` outlives this. O(vertices), of which nothing is allocated the second time.
    void start(vertex_rings const& base) {
        base_ = &base;
        place_.assign(base.vertex_count(), 0);
        changed_.clear();
        rings_.clear();
        corners_.clear();
        neighbors_.clear();
    }

    [[nodiscard]] vertex_rings const& base() const noexcept { return *base_; }
    [[nodiscard]] std::size_t vertex_count() const noexcept { return place_.size(); }
    [[nodiscard]] std::span<corner const> faces(std::size_t v) const noexcept {
        if (place_[v] == 0) return base_->faces(v);
        ring const& r = rings_[place_[v] - 1];
        return {corners_.data() + r.corner_begin, corners_.data() + r.corner_end};
    }
    [[nodiscard]] std::span<std::uint32_t const> neighbors(std::size_t v) const noexcept {
        if (place_[v] == 0) return base_->neighbors(v);
        ring const& r = rings_[place_[v] - 1];
        return {neighbors_.data() + r.neighbor_begin, neighbors_.data() + r.neighbor_end};
    }
    [[nodiscard]] bool is_border(std::size_t v) const noexcept {
        return place_[v] == 0 ? base_->is_border(v) : rings_[place_[v] - 1].border;
    }

    /// After edges were collapsed: `triangles` name the kept vertices for those gone, and what had an edge's both ends as
    /// corners is named by one vertex three times. No end of an edge may be an end or a neighbour of another's. O(triangles around).
    void mend(std::span<merged_vertex const> merged, std::span<std::array<std::uint32_t, 3> const> triangles) {
        around_.clear();
        for (merged_vertex const& m : merged) {
            for (std::uint32_t const end : {m.kept, m.gone}) {
                for (std::uint32_t const w : neighbors(end)) {
                    if (w != m.kept && w != m.gone) around_.push_back(w);
                }
            }
        }
        std::sort(around_.begin(), around_.end());
        around_.erase(std::unique(around_.begin(), around_.end()), around_.end());
        for (merged_vertex const& m : merged) {
            list_.clear();
            auto const a = faces(m.kept);
            auto const b = faces(m.gone);
            std::merge(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(list_),
                       [](corner const& x, corner const& y) { return x.face < y.face; });
            set(m.kept, triangles);
            list_.clear();
            set(m.gone, triangles);
            rings_.back().gone = true;
        }
        for (std::uint32_t const w : around_) {
            auto const a = faces(w);
            list_.assign(a.begin(), a.end());
            set(w, triangles);
        }
    }

    /// The rings with new numbers, for the vertices and triangles that are left, in the same order; of those that are gone
    /// the numbers are not read. `out`, not the base, keeps its memory. O(vertices + faces).
    template <executor E>
    void renumber(std::span<std::uint32_t const> vertex, std::span<std::uint32_t const> face, vertex_rings& out, E const& threads) {
        std::sort(changed_.begin(), changed_.end());
        // Before every changed vertex: how much longer the lists are, and how many vertices are gone.
        shifts_.assign(1, {});
        for (std::uint32_t const v : changed_) {
            shift s = shifts_.back();
            s.corners += faces(v).size() - base_->faces(v).size();
            s.neighbors += neighbors(v).size() - base_->neighbors(v).size();
            s.gone += rings_[place_[v] - 1].gone ? 1U : 0U;
            shifts_.push_back(s);
        }
        std::size_t const n = vertex_count();
        std::size_t const left = n - shifts_.back().gone;
        out.face_begin_.resize(left + 1);
        out.neighbor_begin_.resize(left + 1);
        out.border_.resize(left);
        out.corners_.resize(base_->corners_.size() + shifts_.back().corners);
        out.neighbors_.resize(base_->neighbors_.size() + shifts_.back().neighbors);
        out.face_begin_[left] = static_cast<std::uint32_t>(out.corners_.size());
        out.neighbor_begin_[left] = static_cast<std::uint32_t>(out.neighbors_.size());
        threads.for_blocks(n, 1024, [&](std::size_t begin, std::size_t end) {
            auto at = static_cast<std::size_t>(std::lower_bound(changed_.begin(), changed_.end(), begin) - changed_.begin());
            for (std::size_t v = begin; v < end; ++at) {
                std::size_t const stop = at < changed_.size() ? std::min<std::size_t>(changed_[at], end) : end;
                copy_run(v, stop, shifts_[at], vertex, face, out);
                if (stop < end) copy_changed(stop, shifts_[at], vertex, face, out);
                v = stop + 1;
            }
        });
    }

private:
    struct ring {
        std::size_t corner_begin = 0;
        std::size_t corner_end = 0;
        std::size_t neighbor_begin = 0;
        std::size_t neighbor_end = 0;
        bool border = false;
        bool gone = false;
    };
    struct shift {  // modulo 2^64: lists may be shorter
        std::size_t corners = 0;
        std::size_t neighbors = 0;
        std::size_t gone = 0;
    };

    /// A ring of the triangles of `list_` that are left.
    void set(std::uint32_t v, std::span<std::array<std::uint32_t, 3> const> triangles) {
        ring r{.corner_begin = corners_.size(), .neighbor_begin = neighbors_.size()};
        for (corner const& c : list_) {
            auto const& t = triangles[c.face];
            if (t[0] != t[1]) corners_.push_back(c);
        }
        r.corner_end = corners_.size();
        r.border = vertex_rings::add_neighbors({corners_.data() + r.corner_begin, corners_.data() + r.corner_end}, triangles,
                                               neighbors_, scratch_);
        r.neighbor_end = neighbors_.size();
        rings_.push_back(r);
        if (place_[v] == 0) changed_.push_back(v);
        place_[v] = static_cast<std::uint32_t>(rings_.size());
    }

    /// Of vertices that have the rings of the base.
    void copy_run(std::size_t begin, std::size_t end, shift const& by, std::span<std::uint32_t const> vertex,
                  std::span<std::uint32_t const> face, vertex_rings& out) const noexcept {
        vertex_rings const& in = *base_;
        for (std::size_t v = begin; v < end; ++v) {
            out.face_begin_[v - by.gone] = static_cast<std::uint32_t>(in.face_begin_[v] + by.corners);
            out.neighbor_begin_[v - by.gone] = static_cast<std::uint32_t>(in.neighbor_begin_[v] + by.neighbors);
            out.border_[v - by.gone] = in.border_[v];
        }
        for (std::size_t c = in.face_begin_[begin]; c < in.face_begin_[end]; ++c) {
            out.corners_[c + by.corners] = {face[in.corners_[c].face], in.corners_[c].place};
        }
        for (std::size_t k = in.neighbor_begin_[begin]; k < in.neighbor_begin_[end]; ++k) {
            out.neighbors_[k + by.neighbors] = vertex[in.neighbors_[k]];
        }
    }
    void copy_changed(std::size_t v, shift const& by, std::span<std::uint32_t const> vertex, std::span<std::uint32_t const> face,
                      vertex_rings& out) const noexcept {
        ring const& r = rings_[place_[v] - 1];
        if (r.gone) return;
        std::size_t c = base_->face_begin_[v] + by.corners;
        std::size_t k = base_->neighbor_begin_[v] + by.neighbors;
        out.face_begin_[v - by.gone] = static_cast<std::uint32_t>(c);
        out.neighbor_begin_[v - by.gone] = static_cast<std::uint32_t>(k);
        out.border_[v - by.gone] = r.border ? 1 : 0;
        for (corner const& x : faces(v)) out.corners_[c++] = {face[x.face], x.place};
        for (std::uint32_t const w : neighbors(v)) out.neighbors_[k++] = vertex[w];
    }

    vertex_rings const* base_ = nullptr;
    std::vector<std::uint32_t> place_{};    ///< vertex -> 1 + its ring in `rings_`; 0: it has that of the base
    std::vector<std::uint32_t> changed_{};  ///< vertices with a place
    std::vector<ring> rings_{};
    std::vector<corner> corners_{};
    std::vector<std::uint32_t> neighbors_{};
    std::vector<shift> shifts_{};
    std::vector<std::uint32_t> around_{};
    std::vector<corner> list_{};
    std::vector<std::uint32_t> scratch_{};
};

}  // namespace tafoni::detail

#endif
