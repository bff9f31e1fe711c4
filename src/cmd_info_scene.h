// cmd_info_scene.h — facet info on an OBJ or a scene.

#ifndef CMD_INFO_SCENE_H
#define CMD_INFO_SCENE_H

#include "cmd_shared.h"

// Say what the mesh or scene at path holds, and how it will be shaded;
// returns an exit code.
int info_scene(const options *o, const char *path);

#endif
