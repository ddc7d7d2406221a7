/// \file
/// What every particle of a fluid carries, from step to step.
#ifndef TAFONI_WEATHERING_DETAIL_PARTICLE_LOADS_HPP
#define TAFONI_WEATHERING_DETAIL_PARTICLE_LOADS_HPP

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace tafoni::detail {

/// Totals of a run: what all vertices move by in all iterations, in whole units.
__extension__ using volume_sum = __int128;

/// Loads in whole units, in the order in which the fluid numbers its particles, with the ids that last.
class particle_loads {
public:
    struct entry {
        std::uint64_t id = 0;
        std::int64_t units = 0;
    };

    /// The loads of `then` for the particles there are now; returns what those that are gone carried. Most particles
    /// keep their numbers, and those that do not are looked up: O(n + k log k) where k have others.
    template <class Id>
    volume_sum follow(particle_loads const& then, std::size_t n, Id const& id) {
        all_.resize(n);
        strange_.clear();
        lost_.clear();
        for (std::size_t i = 0; i < n; ++i) {
            std::uint64_t const now = id(i);
            bool const same = i < then.all_.size() && then.all_[i].id == now;
            all_[i] = {now, same ? then.all_[i].units : 0};
            if (!same) strange_.push_back(i);
        }
        for (std::size_t i = 0; i < then.all_.size(); ++i) {
            entry const& e = then.all_[i];
            if (e.units != 0 && !(i < n && all_[i].id == e.id)) lost_.push_back(e);
        }
        if (lost_.empty()) return 0;
        std::sort(lost_.begin(), lost_.end(), [](entry const& a, entry const& b) { return a.id < b.id; });
        for (std::size_t const i : strange_) {
            auto const at = std::lower_bound(lost_.begin(), lost_.end(), all_[i].id, [](entry const& e, std::uint64_t k) { return e.id < k; });
            if (at != lost_.end() && at->id == all_[i].id) all_[i].units = std::exchange(at->units, 0);
        }
        volume_sum gone = 0;
        for (entry const& e : lost_) gone += e.units;
        return gone;
    }

    [[nodiscard]] volume_sum sum() const noexcept {
        volume_sum s = 0;
        for (entry const& e : all_) s += e.units;
        return s;
    }
    /// By the fluid's numbers after `follow`.
    [[nodiscard]] std::vector<entry>& all() noexcept { return all_; }
    [[nodiscard]] std::vector<entry> const& all() const noexcept { return all_; }

private:
    std::vector<entry> all_{};
    std::vector<std::size_t> strange_{};
    std::vector<entry> lost_{};
};

}  // namespace tafoni::detail

#endif
