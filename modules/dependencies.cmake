# The libraries that Patina stands on, each with the Debian package that holds it. All of them are
# looked for before anything else, so that one line can name everything that is missing. Which
# module may use which library is said by the modules' own target_link_libraries().
set(patina_missing "")

# A library that has a CMake configuration or a find module.
#   patina_need(libvtk9-qt-dev VTK 9.1 COMPONENTS CommonCore)
macro(patina_need debian_package library)
  find_package(${library} ${ARGN} QUIET)
  if(NOT ${library}_FOUND)
    list(APPEND patina_missing ${debian_package})
  endif()
endmacro()

# A library that pkg-config knows: PkgConfig::NAME.
macro(patina_need_module debian_package name)
  if(PKG_CONFIG_FOUND)
    pkg_check_modules(${name} QUIET IMPORTED_TARGET ${ARGN})
  endif()
  if(PKG_CONFIG_FOUND AND NOT ${name}_FOUND)
    list(APPEND patina_missing ${debian_package})
  endif()
endmacro()

patina_need(libeigen3-dev Eigen3 3.4 NO_MODULE)
patina_need(libtbb-dev TBB)
patina_need(libc6-dev Threads)
patina_need(nlohmann-json3-dev nlohmann_json)
patina_need(libssl-dev OpenSSL COMPONENTS Crypto)
patina_need(libopenmesh-dev OpenMesh)
if(NOT PATINA_FUZZ)
  patina_need(pkg-config PkgConfig)
  patina_need_module(libopenimageio-dev OPENIMAGEIO OpenImageIO)
  if(PATINA_USB)
    patina_need_module(libusb-1.0-0-dev LIBUSB libusb-1.0)
  endif()
  if(PATINA_ACQUISITION)
    patina_need(libceres-dev Ceres)
    # OpenCV's own configuration asks for all of its libraries; these are found one by one. The
    # markers are in objdetect since OpenCV 4.7 and were in aruco before (vision/aruco.h).
    find_path(OPENCV_HEADERS opencv2/core.hpp PATH_SUFFIXES opencv4)
    set(marker_library aruco)
    if(EXISTS ${OPENCV_HEADERS}/opencv2/objdetect/aruco_detector.hpp)
      set(marker_library objdetect)
    endif()
    find_library(OPENCV_markers opencv_${marker_library})
    if(NOT OPENCV_HEADERS OR NOT OPENCV_markers)
      list(APPEND patina_missing libopencv-contrib-dev)
    endif()
    foreach(part core calib3d imgproc videoio)
      find_library(OPENCV_${part} opencv_${part})
      if(NOT OPENCV_${part})
        list(APPEND patina_missing libopencv-${part}-dev)
      endif()
    endforeach()
    # OpenCV reads videos by it, and tells less of their times than they hold.
    patina_need_module(libavformat-dev AVFORMAT libavformat libavcodec libavutil)
  endif()
  set(PATINA_VTK_COMPONENTS
    CommonCore CommonDataModel CommonExecutionModel FiltersCore FiltersGeneral FiltersSources
    IOCore IOXML IOImage ImagingCore InteractionStyle InteractionWidgets
    RenderingCore RenderingOpenGL2 RenderingAnnotation RenderingFreeType
    ChartsCore ViewsContext2D RenderingContext2D RenderingContextOpenGL2)
  patina_need(libx11-dev X11)
  if(PATINA_GUI)
    patina_need(qtbase5-dev Qt5 COMPONENTS Widgets DBus)
    patina_need(libvtk9-qt-dev VTK 9.1 COMPONENTS ${PATINA_VTK_COMPONENTS} GUISupportQt)
  else()
    patina_need(libvtk9-dev VTK 9.1 COMPONENTS ${PATINA_VTK_COMPONENTS})
  endif()
endif()

if(patina_missing)
  list(REMOVE_DUPLICATES patina_missing)
  list(JOIN patina_missing " " patina_missing)
  message(NOTICE "Missing: ${patina_missing}. Run: apt-get install --no-install-recommends "
                 "${patina_missing}")
  message(FATAL_ERROR "Patina needs libraries that were not found; the line above names them.")
endif()

# The tests are built where their libraries are, unless BUILD_TESTING says otherwise.
if(NOT DEFINED BUILD_TESTING OR BUILD_TESTING)
  set(patina_missing "")
  patina_need(libgtest-dev GTest)
  if(PATINA_GUI AND NOT PATINA_FUZZ)
    patina_need_module(libxcb-xtest0-dev XTEST xcb xcb-xtest)
  endif()
  list(JOIN patina_missing " " patina_missing)
  if(BUILD_TESTING AND patina_missing)
    message(NOTICE "Missing: ${patina_missing}. Run: apt-get install --no-install-recommends "
                   "${patina_missing}")
    message(FATAL_ERROR "The tests need libraries that were not found; the line above names them.")
  endif()
  if(patina_missing)
    set(BUILD_TESTING OFF)
    message(NOTICE "The tests are left out: ${patina_missing} missing")
  else()
    set(BUILD_TESTING ON)
  endif()
else()
  message(NOTICE "The tests are left out: BUILD_TESTING is ${BUILD_TESTING}")
endif()
