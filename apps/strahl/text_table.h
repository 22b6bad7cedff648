// apps/strahl/text_table.h - tables that read well on a terminal and are Markdown, too.
#pragma once

#include <string>
#include <vector>

namespace strahl::cli {

/// The first row is the head; every row has as many cells. "" for a head alone.
std::string text_table(const std::vector<std::vector<std::string>>& rows);

}  // namespace strahl::cli
