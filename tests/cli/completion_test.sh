#!/usr/bin/env bash
# The shells' scripts offer every option of --help-all, and those shells that are installed find no fault
# with them: completion_test.sh PROGRAM...
set -euo pipefail

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

optionsOf() { sed -nE 's/^  (-[a-z],)?--([a-z0-9-]+).*/\2/p' | sort -u; }

# completed PROGRAM WORD...: what bash offers for the last of the words.
completed() {
  COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMPREPLY=()
  "_${1//-/_}"
  echo "${COMPREPLY[*]-}"
}

for program in "$@"; do
  name=$(basename "$program")
  PATH=$(dirname "$program"):$PATH
  for shell in bash zsh fish; do "$program" --completion $shell >"$work/$name.$shell"; done
  bash -n "$work/$name.bash"
  for shell in zsh fish; do
    if command -v $shell >/dev/null; then
      $shell -n "$work/$name.$shell"
    else
      echo "$shell is not installed: whether it takes the completion of $name is NOT checked"
    fi
  done
  . "$work/$name.bash"
  commands=$("$program" --help | sed -n '/^Commands:/,/^$/s/^  \([a-z]*\) .*/\1/p')
  count=0
  for command in ${commands:-""}; do
    offered=$(completed "$name" ${command:+"$command"} --)
    for option in $("$program" ${command:+"$command"} --help-all | optionsOf); do
      [[ " $offered " == *" --$option "* ]] || { echo "bash: $name $command lacks --$option"; exit 1; }
      count=$((count + 1))
    done
    if [ "$command" = render ]; then
      if command -v zsh >/dev/null; then
        test "$(zsh -c "
          compdef() { :; }; _files() { echo files; }
          _describe() { print -r -- \${(P)2}; }
          source $work/$name.zsh
          words=($name render --mode '') CURRENT=4; _$name
          words=($name render --json '') CURRENT=4; _$name")" = "packets reference
files"
      fi
      if command -v fish >/dev/null; then
        test "$(fish -c "source $work/$name.fish; complete -C '$name render --mode r'")" = reference
        fish -c "source $work/$name.fish; complete -C '$name render --sp'" | grep -q "^--spp	samples per pixel"
      fi
      test "$(completed "$name" render --mode '')" = "packets reference"
      test "$(completed "$name" render --sky s)" = studio
      test "$(completed "$name" render --spp 1)" = ""
      test "$(completed "$name" render --channels de)" = depth
      test "$(completed "$name" render --channels depth,no)" = depth,normal
      test "$(completed "$name" render --disable shadows,mi)" = shadows,mirror
    fi
  done
  if [ -n "$commands" ]; then
    test "$(completed "$name" ren)" = render
    test "$(completed "$name" turn)" = turntable
  fi
  echo "$name: $count options"
done
echo "completions: $# passed"
