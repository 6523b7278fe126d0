#include "core/picture_options.h"

#include "core/option_values.h"

namespace whit {

std::vector<std::pair<std::string, std::string>> pictureOptions(const RenderOptions& options) {
  std::vector<std::pair<std::string, std::string>> said;
  forEachOption(options, [&](const std::string& name, const char* placeholder, const char*,
                             const auto& field) {
    if (!changesPicture(name)) return;
    const std::string value = formatValue(renderOptionSpec(name, placeholder), field);
    if (!value.empty()) said.emplace_back(name, value);
  });
  return said;
}

}  // namespace whit
