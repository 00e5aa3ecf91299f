// SPDX-License-Identifier: MIT
// All options of `render`, in the order of --help, in one list for each part of RenderOptions.
#pragma once

#include <span>
#include <vector>

#include "options/option_row.h"

namespace fragtrace {

std::span<const OptionRow> optionRows();

std::vector<OptionRow> fileRows();  ///< the scene and the picture
std::vector<OptionRow> cameraRows();
std::vector<OptionRow> samplingRows();  ///< stages included
std::vector<OptionRow> lightRows();
std::vector<OptionRow> skyRows();
std::vector<OptionRow> fogRows();
std::vector<OptionRow> volumeRows();
std::vector<OptionRow> deviceRows();
std::vector<OptionRow> inputRows();
std::vector<OptionRow> outputRows();

}  // namespace fragtrace
