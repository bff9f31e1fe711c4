// cmd_info_part.h — facet info of parts of pictures.

#ifndef CMD_INFO_PART_H
#define CMD_INFO_PART_H

#include "cmd_shared.h"

// Print of what picture the part at path is, and how far; an exit code.
int info_part(const options *o, const char *path);

#endif
