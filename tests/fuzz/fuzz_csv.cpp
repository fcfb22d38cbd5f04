/// Any bytes as a CSV file, after a NUL as its sidecar: a table whose columns are equally long, or
/// messages.

#include <cstdlib>
#include <fstream>

#include <unistd.h>

#include "runtime/csv/csv_reader.hpp"

using namespace lineshaft;

namespace {

struct Folder {
    Folder() {
        char name[] = "/tmp/lineshaft-fuzz-XXXXXX";
        if (!::mkdtemp(name)) std::abort();
        path = name;
    }
    ~Folder() {
        ::unlink((path + "/t.csv").c_str());
        ::unlink((path + "/t.csv-metadata.json").c_str());
        ::rmdir(path.c_str());
    }
    std::string path;
};

void check(const std::optional<CsvTable>& table, const Diagnostics& out) {
    out.render();
    if (table.has_value() != out.empty()) std::abort();
    if (!table) return;
    for (const CsvColumn& column : table->columns)
        if (column.values.size() != table->rows) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const Folder folder;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const std::string path = folder.path + "/t.csv", beside = sidecar_path(path);
    const std::size_t end = text.find('\0');
    std::ofstream(path, std::ios::binary) << text.substr(0, end);
    if (end == text.npos)
        ::unlink(beside.c_str());
    else
        std::ofstream(beside, std::ios::binary) << text.substr(end + 1);
    for (const bool cut : {false, true}) {
        Diagnostics out;
        const auto table = read_csv(path, out, {.last_row_may_be_cut = cut});
        check(table, out);
    }
    return 0;
}
