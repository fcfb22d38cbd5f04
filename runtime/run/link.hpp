#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "runtime/model/catalog.hpp"
#include "runtime/names/net.hpp"
#include "runtime/outside/modbus_map.hpp"
#include "runtime/program/program.hpp"
#include "runtime/scan/judge.hpp"
#include "runtime/st/library/library.hpp"
#include "runtime/trace/recorder.hpp"

namespace lineshaft {

/// What the sources of a program that is loaded many times are compiled to: once for each
/// controller and setting that makes other code of them. For one thread.
class CompiledSources {
  public:
    /// Null where there is a mistake, of which link() tells.
    std::shared_ptr<const Catalog> kinds(const Program& program, const Catalog& catalog);

  private:
    struct Entry {
        std::vector<std::shared_ptr<const SourceFile>> texts;
        std::vector<std::string> types;  ///< of the blocks
        st::Options options;
        std::shared_ptr<const Catalog> kinds;
    };
    std::vector<Entry> entries_;
};

/// A program that can run.
struct Linked {
    Net net;
    Machine machine;
    std::vector<TraceSetup> traces;
    std::vector<Expectation> expectations;
    ModbusMap modbus;
    nlohmann::ordered_json report = {};  ///< see connect_report()
};

/// Checks every name, type, unit, limit and wire of `program` and lays its blocks out in memory.
/// What is wrong goes to `out`; the result is usable only when nothing went there. `kinds` are used
/// in place of those that the program's sources are compiled to.
Linked link(const Program& program, const Catalog& catalog, Diagnostics& out,
            std::shared_ptr<const Catalog> kinds = nullptr);

}  // namespace lineshaft
