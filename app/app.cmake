find_package(CLI11 REQUIRED)

add_executable(understudy app/main.cpp app/cli/commands.cpp)
target_include_directories(understudy PRIVATE ${PROJECT_SOURCE_DIR})
target_link_libraries(understudy PRIVATE warnings CLI11::CLI11 nlohmann_json::nlohmann_json understudy_core)
