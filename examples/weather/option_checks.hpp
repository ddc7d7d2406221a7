// Checks of options beyond those of the command line library.
#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace weather {

/// Like CLI::Range, but not a number is out of range too.
inline CLI::Validator between(double lo, double hi) {
    std::string const range = "[" + CLI::detail::to_string(lo) + " - " + CLI::detail::to_string(hi) + "]";
    return CLI::Validator(
        [lo, hi, range](std::string& text) {
            double v = 0;
            bool const good = CLI::detail::lexical_cast(text, v) && v >= lo && v <= hi;
            return good ? std::string() : text + " is not in " + range;
        },
        range);
}

/// Refuses a text that says nothing.
inline CLI::Validator filled() {
    return CLI::Validator([](std::string& text) { return text.empty() ? std::string("it is empty") : std::string(); }, "");
}

}  // namespace weather
