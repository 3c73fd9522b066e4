#pragma once
#include <string>

namespace gnomon {

/// The first twelve digits of the commit that is checked out in a folder, from the files of its repository
/// alone: loose and packed references, and linked worktrees. "unknown" where there is none.
std::string git_commit(const std::string& checkout);

}  // namespace gnomon
