// What a run tells beside its result, in one line each on stderr.
#pragma once

#include <tafoni/geometry/triangle_surface.hpp>

#include <nlohmann/json.hpp>

#include <cstddef>
#include <initializer_list>
#include <string>
#include <utility>

namespace weather {

/// `weather: note: TEXT`.
void note(std::string const& text);

/// Options that were given but change nothing.
class unused_options {
public:
    /// Tells each that was given: NAME has no effect WHY.
    void tell(char const* why, std::initializer_list<std::pair<char const*, bool>> options);
    [[nodiscard]] nlohmann::ordered_json json() const { return names_; }  ///< their names

private:
    nlohmann::ordered_json names_ = nlohmann::ordered_json::array();
};

/// How many pairs of triangles cut each other.
struct cut_counts {
    static constexpr std::size_t most_faces = 500000;  ///< of larger surfaces pairs are not counted

    std::size_t before = 0;
    std::size_t after = 0;
    bool counted = false;

    /// O(n log n), n triangles.
    static cut_counts of(tafoni::triangle_surface const& before, tafoni::triangle_surface const& after);
    /// Where there are more than before; `remedy` is what prevents it.
    void tell(std::string const& remedy) const;
    [[nodiscard]] nlohmann::ordered_json json() const;  ///< null where they were not counted
};

}  // namespace weather
