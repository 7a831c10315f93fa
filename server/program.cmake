# The program: options, composition, one file per subcommand.
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)

flogmap_target(options SOURCES option_table.cpp options.cpp serving_options.cpp
               PUBLIC front_end flog camera log nlohmann_json::nlohmann_json PRIVATE CLI11::CLI11)

flogmap_target(pipeline SOURCES capture_control.cpp loop_stage.cpp map_stage.cpp pipeline.cpp pipeline_capture.cpp
                       processor_heat.cpp random_epoch.cpp stage_statistics.cpp
               PUBLIC front_end map_builder loop flog camera Threads::Threads)

flogmap_target(continued_map SOURCES commands/continued_map.cpp
               PUBLIC map_store flog PRIVATE log mapped_views)

flogmap_target(live_desk SOURCES commands/live_desk.cpp PUBLIC board_calibration PRIVATE nlohmann_json::nlohmann_json)

flogmap_target(flogmap EXECUTABLE
  SOURCES
    main.cpp
    command_line.cpp
    commands/calib_check.cpp
    commands/calibrate.cpp
    commands/cameras.cpp
    commands/disparity.cpp
    commands/evaluate.cpp
    commands/evaluate_map.cpp
    commands/export.cpp
    commands/interrupt_watcher.cpp
    commands/map.cpp
    commands/mapping_session.cpp
    commands/merge.cpp
    commands/output_path.cpp
    commands/progress_bar.cpp
    commands/record.cpp
    commands/serve.cpp
    commands/serving.cpp
    commands/simulate.cpp
  PRIVATE board_calibration continued_map live_desk options pipeline hub map_store map_export map_truth trajectory CLI11::CLI11 nlohmann_json::nlohmann_json)
target_compile_definitions(flogmap PRIVATE FLOGMAP_VERSION="${PROJECT_VERSION}")
set_target_properties(flogmap PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
