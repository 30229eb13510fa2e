#pragma once

#include <filesystem>
#include <string>

namespace lumorph::studio {

/// Writes a page of HTML, as `reportPage` makes it, as a PDF of A4 pages with numbers; whole or not at all. In the
/// window's thread or another. Throws DeviceError where the disk refuses.
void writeReportPdf(const std::string& page, const std::filesystem::path& file);

} // namespace lumorph::studio
