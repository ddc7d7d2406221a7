/// \file
/// Runs small scenarios and prints one line `name hash` for each; the hashes must be the same on every
/// compiler, optimisation level, instruction set and number of threads (tests/determinism/run.sh).
/// A new scenario is a function that feeds its result into a `fingerprint`, and one line in `main`.
#include <tafoni/core/random.hpp>
#include <tafoni/core/sum.hpp>
#include <tafoni/core/vector.hpp>

#include <bit>
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <span>
#include <type_traits>

namespace {

/// FNV-1a over the bytes of values, least significant byte first.
class fingerprint {
public:
    template <class T>
        requires std::is_integral_v<T>
    void add(T value) {
        auto const bits = static_cast<std::uint64_t>(value);
        for (int shift = 0; shift < 64; shift += 8) {
            hash_ = (hash_ ^ (bits >> shift & 0xff)) * 0x100000001b3ULL;
        }
    }
    void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
    void add(tafoni::vec3 const& v) {
        for (int axis = 0; axis < 3; ++axis) add(v[axis]);
    }
    template <class T>
    void add(std::span<T const> values) {
        add(values.size());
        for (auto const& value : values) add(value);
    }
    [[nodiscard]] std::uint64_t value() const { return hash_; }

private:
    std::uint64_t hash_ = 0xcbf29ce484222325ULL;
};

void print(char const* name, void (*scenario)(fingerprint&)) {
    fingerprint f;
    scenario(f);
    std::printf("%s %016" PRIx64 "\n", name, f.value());
}

void random_streams(fingerprint& f) {
    for (std::uint64_t index = 0; index < 100; ++index) {
        tafoni::stream s(42, tafoni::stage::user, index);
        for (int draw = 0; draw < 100; ++draw) {
            f.add(s.bits());
            f.add(s.uniform(-3, 5));
            f.add(s.index_below(1000 + index));
            f.add(s.unit_vector());
        }
    }
}

void vector_algebra(fingerprint& f) {
    tafoni::stream s(43, tafoni::stage::user, 0);
    for (int i = 0; i < 1000; ++i) {
        tafoni::vec3 const a = s.unit_vector();
        tafoni::vec3 const b = s.unit_vector();
        f.add(tafoni::dot(a, b));
        f.add(tafoni::cross(a, b));
        f.add(tafoni::length(a));
        f.add(tafoni::normalized(tafoni::vec3{a[0] + b[0], a[1] + b[1], a[2] + b[2]}));
    }
}

void sums(fingerprint& f) {
    for (std::size_t n = 1; n < 5000; n += 37) {
        f.add(tafoni::pairwise_sum(0, n, [](std::size_t i) { return 1.0 / static_cast<double>(i + 1); }));
    }
}

}  // namespace

int main() {
    print("random_streams", random_streams);
    print("vector_algebra", vector_algebra);
    print("sums", sums);
}
