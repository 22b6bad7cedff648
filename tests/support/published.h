// tests/support/published.h - numbers published for the standard scenes, as a table.
#pragma once

#include <cstdlib>
#include <fstream>
#include <map>
#include <string>
#include <tests/support/shared.h>

namespace strahl::test {

/// By "structure,configuration,scene,quantity" of [Havran1999]; needs the shared data.
inline const std::map<std::string, double>& published() {
  static const std::map<std::string, double> table = [] {
    std::map<std::string, double> rows;
    std::ifstream file(shared_dir() / "reference/havran_1999.csv");
    for (std::string line; std::getline(file, line);) {
      const std::size_t comma = line.rfind(',');
      rows[line.substr(0, comma)] = std::atof(line.c_str() + comma + 1);
    }
    return rows;
  }();
  return table;
}

}  // namespace strahl::test
