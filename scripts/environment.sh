# Sourced by the other scripts from the repository's root: the environment they build and run in, and the build.

# Debian's own python carries the ROS modules: another python first on PATH must not be found.
export PATH=/usr/bin:/bin:/usr/sbin:/sbin:$PATH
unset PYTHONHOME PYTHONPATH
# A host name that does not resolve must not matter, and logs stay inside the repository.
export ROS_HOSTNAME=localhost ROS_HOME=$PWD/.ros
unset ROS_IP
export ROSCONSOLE_STDOUT_LINE_BUFFERED=1
if [[ -z ${SOFT_TISSUE_DATA:-} && -d ../shared/data ]]; then
  SOFT_TISSUE_DATA=$(cd ../shared/data && pwd)
  export SOFT_TISSUE_DATA
fi

cached()
{
  sed -n "s/^$1:[A-Z]*=//p" build/CMakeCache.txt
}

# Says why the build folder can't be used, if it can't: CMake keeps what it found first.
why_stale()
{
  [[ -f build/CMakeCache.txt ]] || return 0
  if [[ $(cached CMAKE_HOME_DIRECTORY) != "$PWD" ]]; then
    echo "it belongs to $(cached CMAKE_HOME_DIRECTORY)"
  elif [[ $(cached CMAKE_GENERATOR) != Ninja ]]; then
    echo "it is not built with Ninja"
  elif [[ $(cached PYTHON_EXECUTABLE) != /usr/bin/python3 ]]; then
    echo "it was configured with the python $(cached PYTHON_EXECUTABLE)"
  elif [[ $(cached CATKIN_DEVEL_PREFIX) != "$PWD/devel" ]]; then
    echo "its devel space is not devel/"
  elif [[ ! -f build/build.ninja ]]; then
    echo "its configuration did not finish"
  fi
}

# build_targets TARGET...  Release, in build/, configured anew only when it has to be. The devel space lies beside it,
# for rosrun overlooks programs below a package's own build/.
build_targets()
{
  local reason
  reason=$(why_stale)
  if [[ -n $reason ]]; then
    echo "build/ is made anew: $reason"
    rm -rf build devel
  fi
  if [[ ! -f build/build.ninja ]]; then
    cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release -DCATKIN_DEVEL_PREFIX="$PWD/devel" \
          -DPYTHON_EXECUTABLE=/usr/bin/python3 -DPython3_EXECUTABLE=/usr/bin/python3
  fi
  cmake --build build -j "${JOBS:-2}" --target "$@"
}
