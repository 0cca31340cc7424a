/* library_path.h - where the file of a .lib or .include card is. */
#ifndef DALCS_LIBRARY_PATH_H
#define DALCS_LIBRARY_PATH_H

#include "lexer.h"

/* Is it called as files of models and subcircuits are? */
bool dalcs_library_is_name(const char *path);

/* All behind the name of the card, where it is a path with blanks or brackets that no quotes hold: behind .include any, for
 * nothing follows a path there, behind .lib that of a library. NULL: it is something else. */
const char *dalcs_library_with_blanks(struct dalcs_lexer *lexer, const struct dalcs_card *card);

/* The file: as written, with the slashes of this system, of its name beside the netlist, or of its name among the
 * libraries of the folder DALCS_LIBRARIES of the environment, of the installation or of the source tree. As written where
 * none can be read; NULL when memory runs out. elsewhere: it lies in another folder than the one written. */
const char *dalcs_library_path(struct dalcs_lexer *lexer, const char *name, bool *elsewhere);

#endif
