# For scripts that build more than once; to be sourced.

# useCompilerCache ROOT: builds of the sources in ROOT that share sources and options share their
# objects, wherever they are. Nothing without ccache.
useCompilerCache() {
  command -v ccache >/dev/null || return 0
  CCACHE_DIR=$(ccache --get-config=cache_dir)  # also for tests that build, whose home is another one
  export CCACHE_DIR
  export CMAKE_CXX_COMPILER_LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER:-ccache}
  export CCACHE_SLOPPINESS=${CCACHE_SLOPPINESS:-pch_defines,time_macros,locale,include_file_mtime,include_file_ctime}
  export CCACHE_BASEDIR=${CCACHE_BASEDIR:-$1} CCACHE_NOHASHDIR=${CCACHE_NOHASHDIR:-1}
}
