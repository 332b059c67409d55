#pragma once
#include <string>

#include "sim/diagnosis/closing.hpp"

/// What the terminal and the report say in the same words.
namespace launch::gap {

/// "98.2 % closed", 100 at most: beyond is noise. Of what was no gap, or has grown, that.
std::string closed_words(const sim::diagnosis::Closed& closed);

/// "98.1 … 98.4 %", its interval.
std::string closed_interval(const sim::diagnosis::Closed& closed);

}  // namespace launch::gap
