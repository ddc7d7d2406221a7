/// \file
/// Scratch memory that the blocks of parallel loops borrow.
#ifndef TAFONI_WEATHERING_DETAIL_SCRATCH_POOL_HPP
#define TAFONI_WEATHERING_DETAIL_SCRATCH_POOL_HPP

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace tafoni::detail {

/// As many `T` as threads ever worked at once. Copies start empty.
template <class T>
class scratch_pool {
    struct give_back {
        scratch_pool* home = nullptr;
        void operator()(T* lent) const noexcept {
            std::lock_guard const lock(home->gate_);
            home->idle_[home->count_++].reset(lent);
        }
    };

public:
    scratch_pool() = default;
    scratch_pool(scratch_pool const&) noexcept {}
    scratch_pool(scratch_pool&& other) noexcept : idle_(std::move(other.idle_)), count_(std::exchange(other.count_, 0)) {}
    scratch_pool& operator=(scratch_pool other) noexcept {
        idle_ = std::move(other.idle_);
        count_ = std::exchange(other.count_, 0);
        return *this;
    }
    ~scratch_pool() = default;

    /// Goes back by itself.
    [[nodiscard]] std::unique_ptr<T, give_back> take() {
        {
            std::lock_guard const lock(gate_);
            if (count_ > 0) return {idle_[--count_].release(), give_back{this}};
        }
        auto fresh = std::make_unique<T>();
        std::lock_guard const lock(gate_);
        idle_.emplace_back();
        return {fresh.release(), give_back{this}};
    }

private:
    std::mutex gate_{};
    std::vector<std::unique_ptr<T>> idle_{};  ///< the first `count_` hold something
    std::size_t count_ = 0;
};

}  // namespace tafoni::detail

#endif
