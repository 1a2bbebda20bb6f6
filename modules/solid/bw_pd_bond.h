#include "bw_solid.h"
