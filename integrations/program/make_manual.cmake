# SPDX-License-Identifier: MIT
# Writes the manual page of the program out of what the program says of itself.
# Usage: cmake -D PROGRAM=mien -D VERSION=0.1.0 -D OUT=mien.1 -P make_manual.cmake

# help(RESULT [COMMAND]): the text of `mien help COMMAND`, as roff that is left as it stands.
function(help result)
  execute_process(COMMAND ${PROGRAM} help ${ARGN}
    OUTPUT_VARIABLE text COMMAND_ERROR_IS_FATAL ANY)
  set(${result}_plain "${text}" PARENT_SCOPE)
  string(STRIP "${text}" text)
  string(REGEX REPLACE "\n\n\n+" "\n\n" text "${text}")
  string(REPLACE "\\" "\\e" text "${text}")
  string(REPLACE "-" "\\-" text "${text}")
  string(REPLACE "'" "\\(aq" text "${text}")
  string(REGEX REPLACE "\n\\." "\n\\\\\\\\&." text "\n${text}")
  set(${result} ".nf${text}\n.fi\n" PARENT_SCOPE)
endfunction()

help(overview)
string(REGEX MATCH "Subcommands:\n(  [^\n]*\n)+" commands "${overview_plain}")
string(REGEX MATCHALL "\n  [a-z-]+" commands "${commands}")
if(NOT commands)
  message(FATAL_ERROR "`${PROGRAM} help` lists no subcommands that this script can read")
endif()

set(page ".TH MIEN 1 \"\" \"Mien ${VERSION}\" \"User Commands\"
.SH NAME
mien \\- show, check, evaluate, convert, generate and measure facial rigs in DNA files
.SH SYNOPSIS
.B mien
.RI [ OPTIONS ]
.I COMMAND
.RI [ ARGUMENTS ]
.SH DESCRIPTION
${overview}")
# Each command has more of them.
string(APPEND page ".SH EXAMPLES
.nf
mien demo\\-head \\-o head.dna
mien info head.dna
mien render head.dna \\-\\-set jawOpen=0.6 \\-o open.png
mien inspect head.dna jawOpen
mien eval head.dna \\-\\-input frames.json \\-o out.json
mien export head.dna \\-o head.glb
.fi
")
foreach(command IN LISTS commands)
  string(STRIP "${command}" command)
  if(NOT command STREQUAL "help")
    help(text ${command})
    string(TOUPPER "mien ${command}" title)
    string(APPEND page ".SH ${title}\n${text}")
    # Actions, as of `mien clip`.
    string(REGEX MATCH "Subcommands:\n(  [^\n]*\n)+" actions "${text_plain}")
    string(REGEX MATCHALL "\n  [a-z-]+" actions "${actions}")
    foreach(action IN LISTS actions)
      string(STRIP "${action}" action)
      help(text ${command} ${action})
      string(TOUPPER "mien ${command} ${action}" title)
      string(APPEND page ".SH ${title}\n${text}")
    endforeach()
  endif()
endforeach()
file(WRITE ${OUT} "${page}")
