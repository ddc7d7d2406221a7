// SPEC arguments: name:key=value,key=value; one parser for all processes.
#pragma once

#include <tafoni/core/vector.hpp>

#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace weather {

/// A command line that cannot be meant: exit code 2.
class usage_error : public std::runtime_error {
    using runtime_error::runtime_error;
};

/// One parsed SPEC. A value may be a list, as in `direction=0,-1,0`: a piece without `=` goes on with
/// the value before it. Every key that is asked for becomes known; `done` refuses all others.
class spec {
public:
    /// `option` is named in messages.
    static spec parse(std::string option, std::string const& text);

    [[nodiscard]] std::string const& name() const { return name_; }
    [[nodiscard]] std::string const& text() const { return text_; }
    [[nodiscard]] bool has(std::string const& key);

    /// A number in [lo, hi].
    double number(std::string const& key, double otherwise, double lo, double hi);
    std::vector<double> list(std::string const& key, std::vector<double> otherwise = {});
    tafoni::vec3 vector(std::string const& key, tafoni::vec3 const& otherwise);
    /// A vector of any length but zero, brought to unit length.
    tafoni::vec3 direction(std::string const& key, tafoni::vec3 const& otherwise);
    std::string word(std::string const& key, std::string const& otherwise);

    /// Refuses keys that nobody asked for.
    void done() const;
    [[noreturn]] void fail(std::string const& why) const;

private:
    std::string option_;
    std::string text_;
    std::string name_;
    std::map<std::string, std::vector<std::string>> values_;
    std::vector<std::string> known_;
};

/// `x,y,z`.
tafoni::vec3 parse_vector(std::string const& option, std::string const& text);
/// `x,y,z` brought to unit length.
tafoni::vec3 parse_direction(std::string const& option, std::string const& text);

}  // namespace weather
