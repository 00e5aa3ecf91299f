// SPDX-License-Identifier: MIT
// A sheet of pictures with their names under them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "image/image.h"
#include "view/letters/letters.h"

namespace fragtrace {

/// A cell of a sheet. What it shows is in a file, or there is a reason why it is not.
struct SheetCell {
  std::string name;
  std::filesystem::path picture;  ///< a .png
  std::string failure;            ///< the reason; empty: there is a picture
};

/// The places of cells of one size.
struct SheetLayout {
  glm::ivec2 cell{0};  ///< size of a picture
  int columns = 0;
  int rows = 0;
  int nameHeight = 0;  ///< pixels for the names of a row

  glm::ivec2 size() const;
  /// The place of a cell's picture.
  glm::ivec2 corner(int index) const;
};

/// The layout of that many cells; 0 columns: as many as rows, or one more.
SheetLayout layoutSheet(int count, glm::ivec2 cell, int columns);

/// The sheet as a display shows it, on a white page. Throws InputError where a picture cannot be read.
Image drawSheet(const SheetLayout& layout, const std::vector<SheetCell>& cells, WriteLetters* write);

}  // namespace fragtrace
