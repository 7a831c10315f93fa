# The network side: laws of board and outbox, the wire, and a real hub on a loopback port.
find_package(nlohmann_json REQUIRED)
flogmap_target(synthetic_walk SOURCES synthetic_walk.cpp PUBLIC mapping_data)

# Not a test: a map that grows by itself, to look at and to develop the page against.
flogmap_target(hub_demo EXECUTABLE SOURCES hub_demo.cpp PRIVATE hub synthetic_walk)

flogmap_target(wire_samples SOURCES wire_samples.cpp PUBLIC board PRIVATE proto)
flogmap_target(make_wire_samples EXECUTABLE SOURCES make_wire_samples.cpp PRIVATE wire_samples)
flogmap_test(wire_tests SOURCES wire_golden_test.cpp LINK wire_samples board proto nlohmann_json::nlohmann_json)

flogmap_target(tile_mirror SOURCES tile_mirror.cpp PUBLIC board PRIVATE proto)
flogmap_test(outbox_tests SOURCES outbox_law_test.cpp LINK tile_mirror board proto)

flogmap_target(loopback_hub SOURCES loopback_hub.cpp client_frames.cpp PUBLIC hub PRIVATE network_libraries proto)
flogmap_test(hub_tests SOURCES hub_http_test.cpp hub_stream_test.cpp
             LINK loopback_hub synthetic_walk tile_mirror hub proto nlohmann_json::nlohmann_json)
