/// Any bytes as the sidecar of a trace: a table, or messages.

#include <cstdlib>
#include <fstream>

#include "runtime/csv/csv_reader.hpp"
#include "tests/fuzz/fuzz_folder.hpp"

using namespace lineshaft;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const test::FuzzFolder folder;
    const std::string path = folder.path + "/t.csv";
    static const bool written = [&] {
        std::ofstream(path) << "time,scan,x.position,x.state,on\n0,0,1.5,1,1\n0.001,1,2,0,0\n";
        return true;
    }();
    std::ofstream(sidecar_path(path), std::ios::binary)
        .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
    Diagnostics out;
    const auto table = read_csv(path, out);
    out.render();
    if (!written || table.has_value() != out.empty()) std::abort();
    if (!table) return 0;
    for (const CsvColumn& column : table->columns)
        if (column.values.size() != table->rows) std::abort();
    return 0;
}
