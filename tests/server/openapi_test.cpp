// The interface document and the routes name one another.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/api/docs.hpp"
#include "server/api/resources.hpp"

namespace flogmap {
namespace {

using ::testing::HasSubstr;

TEST(OpenApi, NamesEveryRouteAndNoOther) {
  const std::string yaml(openapi_yaml());
  for (const Route& route : all_routes()) {
    if (route.pattern == "/docs.css") continue;
    std::string path(route.pattern);
    if (const auto at = path.find("/calibrate/{}"); at != std::string::npos)
      path.replace(at, 13, "/calibrate/{side}");
    if (const auto at = path.find("/views/{}"); at != std::string::npos)
      path.replace(at, 9, "/views/{n}.glb");
    for (const std::string name : {"{id}", "{layer}", "{level}", "{tx}", "{ty}"}) {
      if (path.find("/frames/") != std::string::npos) break;
      const auto at = path.find("{}");
      if (at != std::string::npos) path.replace(at, 2, name);
    }
    if (const auto at = path.find("{}"); at != std::string::npos) path.replace(at, 2, "{stream}");
    EXPECT_THAT(yaml, HasSubstr("\n  " + path + ":\n")) << path;
  }
  EXPECT_THAT(openapi_as_html(yaml), HasSubstr("/api/v1/maps/{id}/changes"));
}

}  // namespace
}  // namespace flogmap
