#pragma once
// Reading and writing whole files.

#include <filesystem>
#include <string>
#include <string_view>

namespace gnomon::output {

/// The content of a file. Throws std::runtime_error with the path and the system's reason.
std::string read_file(const std::filesystem::path& path);

/// Write `content` so that at any moment, even if the program is killed, `path` is either as before or whole:
/// a temporary file in the same folder is written, synchronised and renamed. Missing parent folders are
/// created; a symbolic link is followed; a path that exists and is not a regular file (a device or a pipe) is
/// written directly. Throws std::runtime_error with the path and the system's reason; the temporary file is
/// removed then.
void write_file_atomically(const std::filesystem::path& path, std::string_view content);

}  // namespace gnomon::output
