/// \file
/// A whole regular file in memory; everything that is not one is refused before it can block.
#ifndef TAFONI_IO_DETAIL_LOAD_FILE_HPP
#define TAFONI_IO_DETAIL_LOAD_FILE_HPP

#include <tafoni/core/error.hpp>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace tafoni::detail {

[[noreturn]] inline void fail_on_file(char const* who, std::filesystem::path const& path, errc code,
                                      std::string const& what) {
    fail<io_error>(code, std::string(who) + ": " + path.string() + ": " + what,
                   {.kind = entity::file, .file = path.string()});
}

/// A file descriptor that closes itself.
class descriptor {
public:
    explicit descriptor(int number) noexcept : number_(number) {}
    descriptor(descriptor const&) = delete;
    descriptor& operator=(descriptor const&) = delete;
    ~descriptor() {
        if (number_ >= 0) ::close(number_);
    }
    [[nodiscard]] int number() const noexcept { return number_; }
    [[nodiscard]] int release() noexcept {
        int const n = number_;
        number_ = -1;
        return n;
    }

private:
    int number_;
};

/// The bytes of a file.
struct loaded_file {
    std::unique_ptr<char[]> storage{};
    std::size_t size = 0;

    [[nodiscard]] std::string_view bytes() const noexcept { return {storage.get(), size}; }
};

/// Reads a regular file as it is now: at most the size it has when it is opened. O(size).
/// \throws io_error  `cannot_open`, or `not_a_file` for directories, pipes and devices (never blocks on them).
[[nodiscard]] inline loaded_file load_file(char const* who, std::filesystem::path const& path) {
    // O_NONBLOCK: opening a pipe without a writer would wait for one.
    descriptor const file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (file.number() < 0) {
        fail_on_file(who, path, errc::cannot_open, std::string("cannot open: ") + std::strerror(errno));
    }
    struct stat status {};
    if (::fstat(file.number(), &status) != 0) {
        fail_on_file(who, path, errc::cannot_open, std::string("cannot examine: ") + std::strerror(errno));
    }
    if (!S_ISREG(status.st_mode)) {
        char const* const what = S_ISDIR(status.st_mode)    ? "a directory"
                                 : S_ISFIFO(status.st_mode) ? "a pipe"
                                 : S_ISCHR(status.st_mode)  ? "a character device"
                                 : S_ISBLK(status.st_mode)  ? "a block device"
                                                            : "not a regular file";
        fail_on_file(who, path, errc::not_a_file, std::string("expected a regular file, got ") + what);
    }
    loaded_file result;
    std::size_t const claimed = static_cast<std::size_t>(status.st_size);
    result.storage = std::make_unique_for_overwrite<char[]>(claimed + 1);
    while (result.size < claimed) {
        ssize_t const got = ::read(file.number(), result.storage.get() + result.size, claimed - result.size);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) fail_on_file(who, path, errc::truncated, std::string("cannot read: ") + std::strerror(errno));
        if (got == 0) break;
        result.size += static_cast<std::size_t>(got);
    }
    return result;
}

}  // namespace tafoni::detail

#endif
