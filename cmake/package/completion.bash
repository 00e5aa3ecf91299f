# SPDX-License-Identifier: MIT
# Completion of bash for fragtrace. scripts/help_files writes the tables from --help.

# COMMAND: its commands and options.
_fragtrace_names() {
  case "$1" in
@names@
  esac
}

# "COMMAND OPTION", or "COMMAND " for its first argument: what a value is. Nothing for a switch.
_fragtrace_value() {
  case "$1" in
@values@
  esac
}

_fragtrace_files() {
  local extension
  compopt -o filenames 2>/dev/null
  (($#)) || { mapfile -t COMPREPLY < <(compgen -f -- "$cur"); return; }
  mapfile -t COMPREPLY < <(compgen -d -- "$cur"; for extension; do compgen -f -X "!*.$extension" -- "$cur"; done)
}

_fragtrace() {
  local cur=${COMP_WORDS[COMP_CWORD]} command='' option='' before='' at=1
  local -a value
  COMPREPLY=()
  # Bash splits --option=value at the sign.
  if [[ $cur == = ]]; then
    cur='' option=${COMP_WORDS[COMP_CWORD - 1]}
  elif [[ ${COMP_WORDS[COMP_CWORD - 1]} == = ]]; then
    option=${COMP_WORDS[COMP_CWORD - 2]}
  elif [[ ${COMP_WORDS[COMP_CWORD - 1]} == -* ]]; then
    option=${COMP_WORDS[COMP_CWORD - 1]}
  fi
  while ((at < COMP_CWORD)); do
    case "$command" in
      @groups@) [[ ${COMP_WORDS[at]} == -* ]] || command+=${command:+ }${COMP_WORDS[at]} ;;
      *) break ;;
    esac
    at=$((at + 1))
  done
  [[ $option ]] && read -ra value < <(_fragtrace_value "$command $option")
  if [[ ! ${value[*]} ]]; then
    case "$command" in
      @groups@) value=(one) ;;
      *) read -ra value < <(_fragtrace_value "$command ") ;;
    esac
    [[ $cur == -* || ${value[0]} == one ]] && read -ra value < <(echo one "$(_fragtrace_names "$command")")
  fi
  case "${value[0]}" in
    one) mapfile -t COMPREPLY < <(compgen -W "${value[*]:1}" -- "$cur") ;;
    many)
      [[ $cur == *,* ]] && before=${cur%,*},
      mapfile -t COMPREPLY < <(compgen -P "$before" -W "${value[*]:1}" -- "${cur##*,}")
      compopt -o nospace 2>/dev/null ;;
    files) _fragtrace_files "${value[@]:1}" ;;
    folders)
      compopt -o filenames 2>/dev/null
      mapfile -t COMPREPLY < <(compgen -d -- "$cur") ;;
  esac
}

complete -F _fragtrace fragtrace
