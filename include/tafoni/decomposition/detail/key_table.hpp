/// \file
/// A small hash table from three ids to one, for the scratch work on a single triangle.
#ifndef TAFONI_DECOMPOSITION_DETAIL_KEY_TABLE_HPP
#define TAFONI_DECOMPOSITION_DETAIL_KEY_TABLE_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace tafoni::detail {

/// Open addressing with linear probing; emptied in O(1), so one table serves many triangles.
/// The answers depend on what was inserted, never on where it lies in the table.
class key_table {
public:
    using key = std::array<std::uint32_t, 3>;

    key_table() : slots_(64) {}

    void clear() noexcept {
        ++epoch_;
        size_ = 0;
        if (epoch_ == 0) {
            for (slot& s : slots_) s.epoch = 0;
            epoch_ = 1;
        }
    }

    /// The value of `k`, and whether it was there; otherwise it is there from now on with `value`. O(1) expected.
    std::pair<std::uint32_t, bool> find_or_insert(key const& k, std::uint32_t value) {
        if (2 * (size_ + 1) > slots_.size()) grow();
        slot& s = slots_[place(k)];
        if (s.epoch == epoch_) return {s.value, true};
        s = {k, value, epoch_};
        ++size_;
        return {value, false};
    }

private:
    struct slot {
        key id{};
        std::uint32_t value = 0;
        std::uint32_t epoch = 0;
    };

    [[nodiscard]] std::size_t place(key const& k) const noexcept {
        std::uint64_t h = k[0] * 0x9E3779B97F4A7C15ULL;
        h = (h ^ (h >> 32) ^ k[1]) * 0xD6E8FEB86659FD93ULL;
        h = (h ^ (h >> 32) ^ k[2]) * 0xD6E8FEB86659FD93ULL;
        std::size_t const mask = slots_.size() - 1;
        std::size_t at = static_cast<std::size_t>(h ^ (h >> 32)) & mask;
        while (slots_[at].epoch == epoch_ && slots_[at].id != k) at = (at + 1) & mask;
        return at;
    }

    void grow() {
        std::vector<slot> old(slots_.size() * 2);
        old.swap(slots_);
        for (slot const& s : old) {
            if (s.epoch == epoch_) slots_[place(s.id)] = s;
        }
    }

    std::vector<slot> slots_;
    std::size_t size_ = 0;
    std::uint32_t epoch_ = 1;
};

}  // namespace tafoni::detail

#endif
