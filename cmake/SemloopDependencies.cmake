# Everything comes from Debian 12; scripts/install-dependencies.sh installs it.
# semloop-config.cmake repeats the ones that the public headers need.
set(SEMLOOP_MRPT_COMPONENTS config gui hwdrivers img io maps math obs opengl poses rtti serialization
  system tclap tfest)
foreach(component IN LISTS SEMLOOP_MRPT_COMPONENTS)
  find_package(mrpt-${component} 2.5 REQUIRED)
endforeach()
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(OpenCV 4.6 REQUIRED COMPONENTS core imgproc imgcodecs calib3d dnn features2d rgbd)
find_package(Threads REQUIRED)
find_package(Ceres 2.1 REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(openni2 REQUIRED IMPORTED_TARGET libopenni2)
find_package(PCL 1.13 REQUIRED COMPONENTS common features filters kdtree registration search)

# Optional: without them there is no simulation library, and rawlog-simulate says what to install.
find_package(embree 3.13 QUIET)
find_package(tinyobjloader QUIET)
pkg_check_modules(libzip QUIET IMPORTED_TARGET libzip)
if(embree_FOUND AND tinyobjloader_FOUND AND libzip_FOUND)
  set(SEMLOOP_SIMULATION ON)
else()
  set(SEMLOOP_SIMULATION OFF)
  message(STATUS "No simulation: it needs libembree-dev, libtinyobjloader-dev and libzip-dev")
endif()
