#pragma once

#include <mutex>
#include <string>

#include "runtime/model/device.hpp"
#include "runtime/serve/world.hpp"

namespace lineshaft {

/// Who wanted to change something, and what became of it.
struct AuditEntry {
    std::string peer, by;     ///< number of the machine; HTTP or Modbus
    std::string asked;        ///< cut off where it is long
    std::string answer;       ///< `200`, `403 this machine is only looked at`
    std::int64_t at = never;  ///< virtual time from which it counts [ns]; never: it does not
};

/// A line of JSON for each entry, at the end of a file, so that those of earlier machines stay. For
/// any thread.
class Audit {
  public:
    Audit(World& world, std::string path);

    /// Why there are lines missing; empty when all is well.
    std::string error() const;

    void note(const AuditEntry& entry);

  private:
    const std::string path_;
    std::unique_ptr<GrowingFile> file_;
    mutable std::mutex mutex_;
    std::string error_;
};

}  // namespace lineshaft
