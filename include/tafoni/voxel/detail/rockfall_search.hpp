/// \file
/// Whether pieces of bricks hang on the ground, found over as few bricks as it takes.
#ifndef TAFONI_VOXEL_DETAIL_ROCKFALL_SEARCH_HPP
#define TAFONI_VOXEL_DETAIL_ROCKFALL_SEARCH_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/voxel/detail/joint_cuts.hpp>
#include <tafoni/voxel/detail/rockfall_ground.hpp>
#include <tafoni/voxel/detail/rockfall_labels.hpp>
#include <tafoni/voxel/sparse_grid.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace tafoni::detail {

/// A piece of rock within a brick.
struct rock_node {
    std::uint32_t brick = 0;
    std::uint16_t piece = 0;  ///< 0 in a brick of nothing but rock that no joint touches

    friend constexpr auto operator<=>(rock_node const&, rock_node const&) = default;
};

/// Groups of pieces of bricks that hang together, grown best first: through solid bricks towards the ground.
///
/// Labels of bricks are kept from call to call and made again only for bricks that were touched and that
/// a search passes. Groups live for one epoch.
class rockfall_search {
public:
    enum class state : std::uint8_t { growing, held, whole };  ///< whole: nothing left to see, no ground in it
    struct step_event {
        std::uint64_t key;
        rock_node from;
        std::uint8_t face;  ///< -x, +x, -y, +y, -z, +z
        friend constexpr auto operator<=>(step_event const&, step_event const&) = default;
    };
    struct group {
        std::uint32_t parent = 0;
        state is = state::growing;
        std::uint64_t voxels = 0;
        std::vector<rock_node> nodes{};
        std::vector<step_event> ahead{};  // heap
    };

    rockfall_search() = default;
    rockfall_search(sparse_grid const& grid, joint_cuts cuts, rockfall_ground ground)
        : cuts_(std::move(cuts)), ground_(std::move(ground)), slot_(grid.brick_count(), 0),
          uniform_(grid.brick_count()) {}

    [[nodiscard]] joint_cuts const& cuts() const noexcept { return cuts_; }
    [[nodiscard]] rockfall_ground const& ground() const noexcept { return ground_; }
    [[nodiscard]] std::size_t bricks_labelled() const noexcept { return labelled_; }  ///< since construction
    [[nodiscard]] std::size_t faces_passed() const noexcept { return passed_; }       ///< since construction

    /// The brick's rock is not what it was.
    void touch(std::size_t brick) noexcept {
        if (slot_[brick] != 0) labels_[slot_[brick] - 1].valid = false;
    }
    void begin_epoch() {
        ++epoch_;
        groups_.clear();
    }
    /// Labels every brick that needs it.
    template <executor Executor>
    void label_all(sparse_grid const& grid, Executor const& threads) {
        std::vector<std::uint32_t> due;
        for (std::size_t b = 0; b < grid.brick_count(); ++b) {
            if (grid.is_air_brick(b) || is_uniform(grid, b)) continue;
            rock_labels& l = labels_at(b);
            if (!l.valid) due.push_back(static_cast<std::uint32_t>(b));
        }
        threads.for_blocks(due.size(), 4, [&](std::size_t from, std::size_t to) {
            for (std::size_t i = from; i < to; ++i) labels_[slot_[due[i]] - 1].label(grid, cuts_, ground_, due[i]);
        });
        labelled_ += due.size();
    }
    /// Pieces of a brick.
    [[nodiscard]] std::size_t pieces(sparse_grid const& grid, std::size_t brick) {
        if (grid.is_air_brick(brick)) return 0;
        return is_uniform(grid, brick) ? 1 : fresh(grid, brick).pieces.size();
    }
    /// The piece of a rock voxel.
    [[nodiscard]] rock_node node_of(sparse_grid const& grid, voxel v) {
        std::size_t const b = grid.brick_of(v);
        auto const brick = static_cast<std::uint32_t>(b);
        if (is_uniform(grid, b)) return {brick, 0};
        return {brick, fresh(grid, b).piece_at(sparse_grid::column_of(v), v.z & 31)};
    }

    /// The group that holds a piece; a new one that grows where none does.
    std::uint32_t group_of(sparse_grid const& grid, rock_node n) {
        auto const [seen, in] = mark(grid, n);
        if (seen == epoch_) return root(in);
        auto const g = static_cast<std::uint32_t>(groups_.size());
        groups_.emplace_back();
        groups_.back().parent = g;
        take(grid, g, n);
        return g;
    }
    /// No group's number where none holds the piece yet.
    [[nodiscard]] std::uint32_t group_if_seen(sparse_grid const& grid, rock_node n) {
        auto const [seen, in] = mark(grid, n);
        return seen == epoch_ ? root(in) : ~std::uint32_t{0};
    }
    [[nodiscard]] group const& at(std::uint32_t g) const noexcept { return groups_[g]; }
    [[nodiscard]] std::size_t group_count() const noexcept { return groups_.size(); }
    [[nodiscard]] std::uint32_t root(std::uint32_t g) noexcept {
        while (groups_[g].parent != g) g = groups_[g].parent = groups_[groups_[g].parent].parent;
        return g;
    }
    /// Looks across one more face of a group that grows. \return its root, which may be another group's by now.
    std::uint32_t grow(sparse_grid const& grid, std::uint32_t g) {
        if (groups_[g].ahead.empty()) {
            groups_[g].is = state::whole;
            return g;
        }
        std::pop_heap(groups_[g].ahead.begin(), groups_[g].ahead.end(), std::greater<>{});
        step_event const e = groups_[g].ahead.back();
        groups_[g].ahead.pop_back();
        ++passed_;
        std::size_t const there = beyond(grid, e.from.brick, e.face);
        std::uint32_t last = ~std::uint32_t{0};
        across(grid, e.from, e.face, there, [&](std::uint16_t piece) {
            if (piece == last) return;
            last = piece;
            rock_node const n{static_cast<std::uint32_t>(there), piece};
            auto const [seen, in] = mark(grid, n);
            if (seen != epoch_) {
                take(grid, g, n);
            } else {
                g = unite(root(g), root(in));
            }
        });
        return g;
    }
    /// Grows a group until it is known whether the ground holds it. \return its root.
    std::uint32_t settle(sparse_grid const& grid, std::uint32_t g) {
        while (groups_[g].is == state::growing) g = grow(grid, g);
        return g;
    }

    /// Calls f(voxel) for every voxel of a piece.
    template <class F>
    void for_voxels(sparse_grid const& grid, rock_node n, F const& f) {
        auto const [begin, end] = columns(grid, n);
        for (std::size_t c = begin; c < end; ++c) {
            for (std::uint32_t left = bits(grid, n, c); left != 0; left &= left - 1) {
                f(voxel_at(grid, n.brick, c, std::countr_zero(left)));
            }
        }
    }
    /// Calls f(lowest voxel of a run) for every run of a piece that lies on rock across a cut bond.
    template <class F>
    void for_contacts(sparse_grid const& grid, rock_node n, F const& f) {
        if (is_uniform(grid, n.brick) && !has_cuts_below(grid, n.brick)) return;
        std::size_t const under = beyond(grid, n.brick, 4);
        auto const [begin, end] = columns(grid, n);
        for (std::size_t c = begin; c < end; ++c) {
            std::uint32_t const mine = bits(grid, n, c);
            if (mine == 0) continue;
            std::uint32_t cut_above = cuts_.word(2, n.brick, c) & grid.plane_word(voxel_plane::rock, n.brick, c);
            std::uint32_t resting = mine & cut_above << 1;
            if (under != nowhere &&
                (cuts_.word(2, under, c) & grid.plane_word(voxel_plane::rock, under, c)) >> 31 != 0) {
                resting |= mine & 1U;
            }
            for (; resting != 0; resting &= resting - 1) f(voxel_at(grid, n.brick, c, std::countr_zero(resting)));
        }
    }

private:
    static constexpr std::size_t nowhere = ~std::size_t{0};

    struct seen_mark {
        std::uint32_t epoch = 0;
        std::uint32_t group = 0;
    };

    static voxel voxel_at(sparse_grid const& grid, std::size_t brick, std::size_t c, int z) noexcept {
        return grid.brick_corner(brick) +
               voxel{static_cast<std::int32_t>(c & 31), static_cast<std::int32_t>(c >> 5), z};
    }
    /// All of it one piece, for certain.
    [[nodiscard]] bool is_uniform(sparse_grid const& grid, std::size_t b) const noexcept {
        return grid.is_rock_brick(b) && cuts_.of(b) == nullptr;
    }
    [[nodiscard]] bool has_cuts_below(sparse_grid const& grid, std::size_t b) const noexcept {
        std::size_t const under = beyond(grid, b, 4);
        return under != nowhere && cuts_.of(under) != nullptr;
    }
    [[nodiscard]] static std::size_t beyond(sparse_grid const& grid, std::size_t b, std::uint8_t face) noexcept {
        voxel const low = grid.brick_corner(b);
        std::array<std::int32_t, 3> const at{low.x >> 5, low.y >> 5, low.z >> 5};
        auto const& n = grid.bricks();
        std::size_t const axis = face / 2U;
        if (at[axis] == (face % 2 == 0 ? 0 : n[axis] - 1)) return nowhere;
        auto const stride = static_cast<std::size_t>(axis == 0 ? 1 : axis == 1 ? n[0] : n[0] * n[1]);
        return face % 2 == 0 ? b - stride : b + stride;
    }
    rock_labels& labels_at(std::size_t b) {
        if (slot_[b] == 0) {
            labels_.emplace_back();
            slot_[b] = static_cast<std::uint32_t>(labels_.size());
        }
        return labels_[slot_[b] - 1];
    }
    rock_labels& fresh(sparse_grid const& grid, std::size_t b) {
        rock_labels& l = labels_at(b);
        if (!l.valid) {
            l.label(grid, cuts_, ground_, b);
            ++labelled_;
        }
        return l;
    }
    [[nodiscard]] seen_mark mark(sparse_grid const& grid, rock_node n) {
        if (is_uniform(grid, n.brick)) return uniform_[n.brick];
        auto const& p = fresh(grid, n.brick).pieces[n.piece];
        return {p.epoch, p.group};
    }
    /// Those that a piece is in are among begin .. end - 1.
    struct column_range {
        std::size_t begin, end;
    };
    [[nodiscard]] column_range columns(sparse_grid const& grid, rock_node n) {
        if (is_uniform(grid, n.brick)) return {0, 1024};
        auto const& p = fresh(grid, n.brick).pieces[n.piece];
        return {p.first_column, std::size_t{p.last_column} + 1};
    }
    [[nodiscard]] std::uint32_t bits(sparse_grid const& grid, rock_node n, std::size_t c) {
        return is_uniform(grid, n.brick) ? grid.inside_word(n.brick, c) : fresh(grid, n.brick).bits(c, n.piece);
    }

    /// Puts a piece that nothing has seen in a group.
    void take(sparse_grid const& grid, std::uint32_t g, rock_node n) {
        group& into = groups_[g];
        into.nodes.push_back(n);
        bool held = false;
        unsigned faces = 63;
        if (is_uniform(grid, n.brick)) {
            uniform_[n.brick] = {epoch_, g};
            std::array<std::size_t, 3> edges{};
            voxel const low = grid.brick_corner(n.brick);
            std::array<std::int32_t, 3> const at{low.x, low.y, low.z};
            for (std::size_t d = 0; d < 3; ++d) {
                edges[d] = std::min<std::size_t>(32, grid.size()[d] - static_cast<std::size_t>(at[d]));
            }
            into.voxels += edges[0] * edges[1] * edges[2];
            if (ground_.may_hold(grid, n.brick)) {
                for (std::size_t c = 0; c < 1024 && !held; ++c) {
                    held = (ground_.word(grid, n.brick, c) & grid.inside_word(n.brick, c)) != 0;
                }
            }
        } else {
            auto& p = fresh(grid, n.brick).pieces[n.piece];
            p.epoch = epoch_;
            p.group = g;
            into.voxels += p.voxels;
            held = p.ground;
            faces = p.faces;
        }
        if (held) {
            into.is = state::held;
            return;
        }
        for (std::uint8_t face = 0; face < 6; ++face) {
            if ((faces >> face & 1U) == 0) continue;
            std::size_t const there = beyond(grid, n.brick, face);
            if (there == nowhere || grid.is_air_brick(there)) continue;
            // Solid bricks cost least to cross, bricks without fresh labels most.
            std::uint64_t const dear = is_uniform(grid, there)                                ? 0
                                       : slot_[there] != 0 && labels_[slot_[there] - 1].valid ? 1
                                                                                              : 2;
            into.ahead.push_back({dear << 32 | ground_.distance(grid, there), n, face});
            std::push_heap(into.ahead.begin(), into.ahead.end(), std::greater<>{});
        }
    }
    std::uint32_t unite(std::uint32_t a, std::uint32_t b) {
        if (a == b) return a;
        bool const held = groups_[a].is == state::held || groups_[b].is == state::held;
        if (groups_[a].nodes.size() < groups_[b].nodes.size()) std::swap(a, b);
        group& into = groups_[a];
        group& from = groups_[b];
        from.parent = a;
        into.voxels += from.voxels;
        into.nodes.insert(into.nodes.end(), from.nodes.begin(), from.nodes.end());
        for (step_event const& e : from.ahead) {
            into.ahead.push_back(e);
            std::push_heap(into.ahead.begin(), into.ahead.end(), std::greater<>{});
        }
        from.nodes = {};
        from.ahead = {};
        if (held) into.is = state::held;
        return a;
    }

    /// Calls f(piece of `there`) for every bond that leads from a piece across a face, at least once for each piece.
    template <class F>
    void across(sparse_grid const& grid, rock_node from, std::uint8_t face, std::size_t there, F const& f) {
        std::size_t const axis = face / 2U;
        bool const up = face % 2 == 1;
        bool const solid = is_uniform(grid, from.brick);
        bool const solid_there = is_uniform(grid, there);
        if (solid && solid_there) return f(0);
        std::size_t const lower = up ? from.brick : there;
        if (!solid) fresh(grid, from.brick);
        if (!solid_there) fresh(grid, there);
        auto const [begin, end] = columns(grid, from);
        rock_labels const* const mine = solid ? nullptr : &labels_[slot_[from.brick] - 1];
        rock_labels const* const theirs = solid_there ? nullptr : &labels_[slot_[there] - 1];
        auto const own = [&](std::size_t c) {
            return solid ? grid.inside_word(from.brick, c) : mine->bits(c, from.piece);
        };
        auto const reach = [&](std::size_t c, std::uint32_t bonds) {
            if (bonds == 0) return;
            if (solid_there) return f(0);
            for (auto const* r = theirs->begin(c); r != theirs->end(c); ++r) {
                if ((r->bits() & bonds) != 0) f(r->piece);
            }
        };
        if (axis < 2) {
            std::size_t const along = axis == 0 ? 32 : 1;
            std::size_t const far_side = axis == 0 ? 31 : 31 * 32;
            for (std::size_t i = 0; i < 32; ++i) {
                std::size_t const low_side = i * along;
                std::size_t const c = low_side + (up ? far_side : 0);
                if (c < begin || c >= end) continue;
                std::size_t const d = low_side + (up ? 0 : far_side);
                reach(d, own(c) & ~cuts_.word(axis, lower, low_side + far_side));
            }
            return;
        }
        for (std::size_t c = begin; c < end; ++c) {
            if (cuts_.word(2, lower, c) >> 31 != 0) continue;
            std::uint32_t const bit = up ? own(c) >> 31 : (own(c) & 1U) << 31;
            reach(c, bit);
        }
    }
    joint_cuts cuts_{};
    rockfall_ground ground_{};
    std::vector<std::uint32_t> slot_{};
    std::vector<rock_labels> labels_{};
    std::vector<seen_mark> uniform_{};
    std::vector<group> groups_{};
    std::uint32_t epoch_ = 0;
    std::size_t labelled_ = 0;
    std::size_t passed_ = 0;
};

}  // namespace tafoni::detail

#endif
