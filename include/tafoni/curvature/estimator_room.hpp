/// \file
/// Memory that estimators of curvature keep from one call to the next.
#ifndef TAFONI_CURVATURE_ESTIMATOR_ROOM_HPP
#define TAFONI_CURVATURE_ESTIMATOR_ROOM_HPP

#include <algorithm>
#include <cstddef>
#include <memory>
#include <mutex>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace tafoni {

/// Scratch memory that is lent and comes back, for callers that estimate again and again: fresh pages cost several
/// threads more than the sums that they hold. Put its address into `surface_view::room`.
///
/// After one use by a shipped estimator it holds up to 64 bytes per vertex, with several threads also 4 per
/// face for each of them, up to 16.
/// Several threads may use it at once. Copies start empty.
class estimator_room {
    static constexpr std::align_val_t line{64};
    struct release {
        void operator()(std::byte* p) const noexcept { ::operator delete(p, line); }
    };
    struct block {
        std::unique_ptr<std::byte, release> bytes{};
        std::size_t size = 0;
    };

public:
    estimator_room() = default;
    estimator_room(estimator_room const&) noexcept {}
    estimator_room(estimator_room&& other) noexcept : idle_(std::move(other.idle_)) {}
    estimator_room& operator=(estimator_room other) noexcept {
        idle_ = std::move(other.idle_);
        return *this;
    }
    ~estimator_room() = default;

    /// An array on loan, its numbers undefined; goes back at the end of its life.
    template <class T>
    class array {
    public:
        array(estimator_room& home, std::size_t size) : home_(home), block_(home.take(size * sizeof(T))), size_(size) {
            if constexpr (!std::is_trivially_copyable_v<T>) std::uninitialized_default_construct_n(begin(), size);
        }
        array(array const&) = delete;
        array& operator=(array const&) = delete;
        ~array() { home_.give_back(std::move(block_)); }

        [[nodiscard]] T* begin() const noexcept { return reinterpret_cast<T*>(block_.bytes.get()); }
        [[nodiscard]] T* end() const noexcept { return begin() + size_; }
        [[nodiscard]] T* data() const noexcept { return begin(); }
        [[nodiscard]] std::size_t size() const noexcept { return size_; }
        [[nodiscard]] T& operator[](std::size_t i) const noexcept { return begin()[i]; }

    private:
        static_assert(std::is_trivially_destructible_v<T> && alignof(T) <= 64);
        estimator_room& home_;
        block block_;
        std::size_t size_;
    };

    /// Bytes that are kept and not on loan. O(arrays).
    [[nodiscard]] std::size_t idle_bytes() const {
        std::lock_guard const lock(gate_);
        std::size_t sum = 0;
        for (block const& b : idle_) sum += b.size;
        return sum;
    }

private:
    [[nodiscard]] block take(std::size_t size) {
        std::lock_guard const lock(gate_);
        auto best = idle_.end();
        for (auto b = idle_.begin(); b != idle_.end(); ++b) {
            if (b->size >= size && (best == idle_.end() || b->size < best->size)) best = b;
        }
        if (best == idle_.end()) {
            if (idle_.capacity() < lent_ + idle_.size() + 1) idle_.reserve(2 * (lent_ + idle_.size()) + 4);
            block fresh{std::unique_ptr<std::byte, release>(static_cast<std::byte*>(::operator new(size, line))), size};
            // The largest of those too small goes for it, or a growing mesh would leave all its sizes behind.
            auto const replaced = std::max_element(idle_.begin(), idle_.end(), [](block const& a, block const& b) { return a.size < b.size; });
            if (replaced != idle_.end()) idle_.erase(replaced);
            ++lent_;
            return fresh;
        }
        block found = std::move(*best);
        idle_.erase(best);
        ++lent_;
        return found;
    }
    void give_back(block b) noexcept {
        std::lock_guard const lock(gate_);
        --lent_;
        if (idle_.size() < idle_.capacity()) idle_.push_back(std::move(b));  // always, unless moved from in between
    }

    mutable std::mutex gate_{};
    std::vector<block> idle_{};
    std::size_t lent_ = 0;
};

}  // namespace tafoni

#endif
