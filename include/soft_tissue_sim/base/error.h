#pragma once

#include <stdexcept>
#include <string>

namespace soft_tissue
{
/** The one exception type the library throws: bad input, said so that its user can mend it. */
class Error : public std::runtime_error
{
 public:
  explicit Error(const std::string& message) : std::runtime_error(message) {}
};

}  // namespace soft_tissue
