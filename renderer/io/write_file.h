/// \file  Files that appear whole or not at all.
#pragma once

#include <filesystem>
#include <string_view>

namespace plumb {

/// Writes `.NAME.PID.tmp` beside the target, flushes it to the disk and renames it onto the target.
/// Whatever fails, the target stays as it was and the temporary is gone. A symbolic link is
/// followed; a device or pipe (which cannot be replaced) is written directly. Each process has its
/// own temporary: of two that write one file, the last wins with a whole file. The permissions of a
/// file that is replaced are kept. Throws SceneError (ErrorKind::output) with path and reason.
///
/// Beyond a file-size limit the system sends SIGXFSZ before write() can fail: a program that wants
/// an error there ignores the signal.
void atomic_write(const std::filesystem::path& target, std::string_view bytes);

/// Throws what atomic_write would throw for reasons that can be known beforehand: the folder is
/// missing or read-only, the target is a folder or read-only. Writes nothing.
void check_writable(const std::filesystem::path& target);

} // namespace plumb
