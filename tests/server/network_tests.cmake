# The network side: laws of board and outbox, the wire, and a real hub on a loopback port.
flogmap_target(synthetic_walk SOURCES synthetic_walk.cpp PUBLIC mapping_data)

# Not a test: a map that grows by itself, to look at and to develop the page against.
flogmap_target(hub_demo EXECUTABLE SOURCES hub_demo.cpp PRIVATE hub synthetic_walk)
