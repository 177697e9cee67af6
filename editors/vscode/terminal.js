// What is typed into a terminal for a lens.
"use strict";

const PLAIN = /^[\w@%+=:,./\\-]+$/;
const NAME = /^\w[\w.-]*$/;

/** `PROGRAM VERB NAME` for a shell; throws where a name is none of a file of a project. */
function commandLine(program, verb, name) {
  if (!NAME.test(name)) throw new Error(`\`${name}\` is no name of a story or motion`);
  return [...program.map((word) => (PLAIN.test(word) ? word : `"${word}"`)), verb, name].join(" ");
}

module.exports = { commandLine };
