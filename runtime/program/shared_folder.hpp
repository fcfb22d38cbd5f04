#pragma once

#include <filesystem>

namespace lineshaft {

/// Where lineshaft's own files are, `config/` with controllers and the schema: beside an installed
/// command (../share/lineshaft), or in the checkout that it was built in. Empty: nowhere.
const std::filesystem::path& shared_folder();

}  // namespace lineshaft
