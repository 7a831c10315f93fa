#pragma once

#include <string>
#include <string_view>

namespace flogmap {

/// server/openapi.yaml, as it was built in.
std::string_view openapi_yaml();

/// An OpenAPI document as one page of HTML, readable without scripts or network.
std::string openapi_as_html(std::string_view yaml);

}  // namespace flogmap
