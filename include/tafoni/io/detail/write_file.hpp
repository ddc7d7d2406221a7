/// \file
/// Writes a file so that its old or its new content is there whole, whatever happens meanwhile.
#ifndef TAFONI_IO_DETAIL_WRITE_FILE_HPP
#define TAFONI_IO_DETAIL_WRITE_FILE_HPP

#include <tafoni/io/detail/load_file.hpp>

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

namespace tafoni::detail {

/// While it lives, a write beyond the file size limit fails instead of killing the process.
class size_limit_signal_blocked {
public:
    size_limit_signal_blocked() noexcept {
        ::sigemptyset(&signal_);
        ::sigaddset(&signal_, SIGXFSZ);
        sigset_t pending;
        ::sigpending(&pending);
        was_pending_ = ::sigismember(&pending, SIGXFSZ) == 1;
        ::pthread_sigmask(SIG_BLOCK, &signal_, &before_);
    }
    size_limit_signal_blocked(size_limit_signal_blocked const&) = delete;
    size_limit_signal_blocked& operator=(size_limit_signal_blocked const&) = delete;
    ~size_limit_signal_blocked() {
        timespec const at_once{0, 0};
        if (!was_pending_) ::sigtimedwait(&signal_, nullptr, &at_once);
        ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    }

private:
    sigset_t signal_{};
    sigset_t before_{};
    bool was_pending_ = false;
};

[[noreturn]] inline void fail_to_write(char const* who, std::filesystem::path const& path, char const* what, int error) {
    fail_on_file(who, path, errc::write_failed, std::string(what) + ": " + std::strerror(error));
}

/// All bytes, and then what the system held back: a full disk shows up here or at the close.
inline int write_all(int file, std::string_view bytes) noexcept {
    size_limit_signal_blocked const blocked;
    while (!bytes.empty()) {
        ssize_t const n = ::write(file, bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return errno;
        bytes.remove_prefix(static_cast<std::size_t>(n));
    }
    // EINVAL: the target (a device) can not be synchronised.
    while (::fsync(file) != 0) {
        if (errno == EINVAL || errno == EROFS) break;
        if (errno != EINTR) return errno;
    }
    return 0;
}

/// Where a chain of symbolic links ends; the end itself need not exist.
[[nodiscard]] inline std::filesystem::path follow_links(char const* who, std::filesystem::path path) {
    for (int depth = 0; depth < 40; ++depth) {
        std::error_code error;
        if (!std::filesystem::is_symlink(std::filesystem::symlink_status(path, error))) return path;
        std::filesystem::path const target = std::filesystem::read_symlink(path, error);
        if (error) fail_to_write(who, path, "cannot follow the link", error.value());
        path = target.is_absolute() ? target : path.parent_path() / target;
    }
    fail_to_write(who, path, "cannot follow the link", ELOOP);
}

/// Replaces the content of `path` by `bytes`, atomically: a temporary file beside it is written,
/// synchronised, closed and renamed. On failure the old file is as it was and nothing is left behind;
/// a process killed meanwhile may leave a file .tafoni-*.tmp. A link keeps pointing to the file, which is
/// replaced; permissions of an existing file are kept. A character device is written to directly.
/// \throws io_error  `write_failed`, or `not_a_file` for directories, pipes and sockets.
inline void write_file(char const* who, std::filesystem::path const& path, std::string_view bytes) {
    std::filesystem::path const target = follow_links(who, path);
    struct stat status {};
    bool const exists = ::stat(target.c_str(), &status) == 0;
    if (!exists && errno != ENOENT) fail_to_write(who, path, "cannot write", errno);
    if (exists && S_ISCHR(status.st_mode)) {
        int const device = ::open(target.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
        if (device < 0) fail_to_write(who, path, "cannot open", errno);
        int error = write_all(device, bytes);
        if (::close(device) != 0 && error == 0) error = errno;
        if (error != 0) fail_to_write(who, path, "cannot write", error);
        return;
    }
    if (exists && !S_ISREG(status.st_mode)) {
        fail_on_file(who, path, errc::not_a_file, std::string("expected a regular file or none, got ") +
                                                      (S_ISDIR(status.st_mode) ? "a directory" : "a special file"));
    }
    // A file that its owner has made read-only would be replaced all the same.
    if (exists && ::access(target.c_str(), W_OK) != 0) fail_to_write(who, path, "cannot write", errno);

    std::filesystem::path temporary;
    int number = -1;
    for (int attempt = 0; number < 0 && attempt < 1000; ++attempt) {
        temporary = target.parent_path() / (".tafoni-" + std::to_string(::getpid()) + "-" + std::to_string(attempt) + ".tmp");
        number = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (number < 0 && errno != EEXIST) fail_to_write(who, path, "cannot create a file in its directory", errno);
    }
    if (number < 0) fail_to_write(who, path, "cannot create a file in its directory", EEXIST);

    int error = 0;
    if (exists && ::fchmod(number, status.st_mode & 07777) != 0) error = errno;
    if (error == 0) error = write_all(number, bytes);
    if (::close(number) != 0 && error == 0) error = errno;
    if (error == 0 && ::rename(temporary.c_str(), target.c_str()) != 0) error = errno;
    if (error != 0) {
        ::unlink(temporary.c_str());
        fail_to_write(who, path, "cannot write", error);
    }
    // The rename itself survives a power cut only when the directory is synchronised; not every system can.
    std::filesystem::path const folder = target.parent_path().empty() ? "." : target.parent_path();
    descriptor const directory(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (directory.number() >= 0) static_cast<void>(::fsync(directory.number()));
}

}  // namespace tafoni::detail

#endif
