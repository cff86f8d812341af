/// \file  The progress line on stderr.
#pragma once

#include <string>

namespace plumb::bench {

/// On a terminal one line that moves, elsewhere a line each time the stage changes.
class Progress {
  public:
    explicit Progress(bool quiet);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// A longer piece of work, such as a mesh and a set of rays.
    void stage(const std::string& what);
    /// How far it is: shown on terminals only.
    void detail(const std::string& what);

  private:
    void show(const std::string& line);

    bool quiet_, terminal_, shown_ = false;
    std::string stage_;
};

} // namespace plumb::bench
