/// \file
/// Signed integers of a fixed number of 64-bit limbs, for exact signs.
#ifndef TAFONI_GEOMETRY_WIDE_INT_HPP
#define TAFONI_GEOMETRY_WIDE_INT_HPP

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace tafoni {

/// A two's complement integer of 64 N bits, least limb first.
///
/// A product has as many limbs as its factors together, so it never overflows. A sum has as many
/// as the wider summand: the caller leaves spare bits (lattice differences leave six per limb).
template <std::size_t N>
struct wide_int {
    std::array<std::uint64_t, N> limb{};

    constexpr wide_int() = default;
    constexpr explicit wide_int(std::int64_t v) noexcept {
        limb[0] = static_cast<std::uint64_t>(v);
        for (std::size_t k = 1; k < N; ++k) limb[k] = v < 0 ? ~std::uint64_t{0} : 0;
    }
    /// Sign-extends a narrower integer.
    template <std::size_t M>
        requires(M < N)
    constexpr explicit wide_int(wide_int<M> const& a) noexcept {
        for (std::size_t k = 0; k < N; ++k) limb[k] = k < M ? a.limb[k] : a.fill();
    }

    [[nodiscard]] constexpr bool negative() const noexcept { return limb[N - 1] >> 63 != 0; }
    /// The limb that all higher limbs would have.
    [[nodiscard]] constexpr std::uint64_t fill() const noexcept { return negative() ? ~std::uint64_t{0} : 0; }

    /// -1, 0 or 1.
    [[nodiscard]] constexpr int sign() const noexcept {
        if (negative()) return -1;
        std::uint64_t any = 0;
        for (auto l : limb) any |= l;
        return any != 0 ? 1 : 0;
    }

    friend constexpr bool operator==(wide_int const&, wide_int const&) = default;
};

namespace detail {
__extension__ using u128 = unsigned __int128;
__extension__ using i128 = __int128;

template <std::size_t N, std::size_t M>
inline constexpr std::size_t wider = N < M ? M : N;
}  // namespace detail

template <std::size_t N, std::size_t M>
[[nodiscard, gnu::always_inline]] constexpr wide_int<detail::wider<N, M>> operator+(wide_int<N> const& a, wide_int<M> const& b) noexcept {
    wide_int<detail::wider<N, M>> r;
    std::uint64_t carry = 0;
    for (std::size_t k = 0; k < r.limb.size(); ++k) {
        detail::u128 const s = detail::u128{k < N ? a.limb[k] : a.fill()} + (k < M ? b.limb[k] : b.fill()) + carry;
        r.limb[k] = static_cast<std::uint64_t>(s);
        carry = static_cast<std::uint64_t>(s >> 64);
    }
    return r;
}

template <std::size_t N>
[[nodiscard, gnu::always_inline]] constexpr wide_int<N> operator-(wide_int<N> const& a) noexcept {
    wide_int<N> r;
    std::uint64_t carry = 1;
    for (std::size_t k = 0; k < N; ++k) {
        r.limb[k] = ~a.limb[k] + carry;
        carry = carry != 0 && r.limb[k] == 0 ? 1 : 0;
    }
    return r;
}

template <std::size_t N, std::size_t M>
[[nodiscard, gnu::always_inline]] constexpr wide_int<detail::wider<N, M>> operator-(wide_int<N> const& a, wide_int<M> const& b) noexcept {
    wide_int<detail::wider<N, M>> r;
    std::uint64_t borrow = 0;
    for (std::size_t k = 0; k < r.limb.size(); ++k) {
        detail::u128 const s = detail::u128{k < N ? a.limb[k] : a.fill()} - (k < M ? b.limb[k] : b.fill()) - borrow;
        r.limb[k] = static_cast<std::uint64_t>(s);
        borrow = static_cast<std::uint64_t>(s >> 64) & 1;
    }
    return r;
}

/// O(N M).
template <std::size_t N, std::size_t M>
[[nodiscard, gnu::always_inline]] constexpr wide_int<N + M> operator*(wide_int<N> const& a, wide_int<M> const& b) noexcept {
    wide_int<N + M> r;
    for (std::size_t i = 0; i < N; ++i) {
        std::uint64_t carry = 0;
        for (std::size_t j = 0; j < M; ++j) {
            detail::u128 const s = detail::u128{a.limb[i]} * b.limb[j] + r.limb[i + j] + carry;
            r.limb[i + j] = static_cast<std::uint64_t>(s);
            carry = static_cast<std::uint64_t>(s >> 64);
        }
        r.limb[i + M] = carry;
    }
    // Read as unsigned, a negative factor is 2^(64 n) too large: take the other one off again, shifted.
    auto const correct = [&r](auto const& other, std::size_t shift, std::uint64_t mask) {
        std::uint64_t borrow = 0;
        for (std::size_t k = 0; k < other.limb.size(); ++k) {
            detail::u128 const s = detail::u128{r.limb[k + shift]} - (other.limb[k] & mask) - borrow;
            r.limb[k + shift] = static_cast<std::uint64_t>(s);
            borrow = static_cast<std::uint64_t>(s >> 64) & 1;
        }
    };
    correct(b, N, a.fill());
    correct(a, M, b.fill());
    return r;
}

/// The product of two 64-bit integers: one instruction.
[[nodiscard, gnu::always_inline]] constexpr wide_int<2> operator*(wide_int<1> const& a, wide_int<1> const& b) noexcept {
    detail::i128 const p = detail::i128{static_cast<std::int64_t>(a.limb[0])} * static_cast<std::int64_t>(b.limb[0]);
    wide_int<2> r;
    r.limb = {static_cast<std::uint64_t>(p), static_cast<std::uint64_t>(static_cast<detail::u128>(p) >> 64)};
    return r;
}

/// Two or three multiplications instead of the general loop with its corrections.
[[nodiscard, gnu::always_inline]] constexpr wide_int<3> operator*(wide_int<1> const& a, wide_int<2> const& b) noexcept {
    detail::i128 const f = static_cast<std::int64_t>(a.limb[0]);
    detail::i128 const low = f * static_cast<detail::i128>(b.limb[0]);
    detail::i128 const high = f * static_cast<std::int64_t>(b.limb[1]) + (low >> 64);
    wide_int<3> r;
    r.limb = {static_cast<std::uint64_t>(low), static_cast<std::uint64_t>(high),
              static_cast<std::uint64_t>(static_cast<detail::u128>(high) >> 64)};
    return r;
}

/// The nearest double but for two units in the last place; the same bits everywhere.
template <std::size_t N>
[[nodiscard]] constexpr double to_double(wide_int<N> const& a) noexcept {
    wide_int<N> const m = a.negative() ? -a : a;
    double v = 0;
    for (std::size_t k = N; k-- > 0;) v = v * 0x1p64 + static_cast<double>(m.limb[k]);
    return a.negative() ? -v : v;
}

}  // namespace tafoni

#endif
