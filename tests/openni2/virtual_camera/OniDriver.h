#pragma once

// The driver's header wants the name that compilers had before they knew of standards.
#ifndef linux
#define linux 1
#endif
#include <new>
#define XN_NEW(type, ...) new type(__VA_ARGS__)
#define XN_DELETE(pointer) delete (pointer)
#include <Driver/OniDriverAPI.h>
