#pragma once

namespace semloop
{
/** Sets OpenNI2 up, once for the process: each time its drivers look through all of USB. Meanwhile it changes
 *  the working directory, so do this before a second thread opens files by relative names. Throws InputError
 *  when there are no drivers. */
void startOpenNi2();

}  // namespace semloop
