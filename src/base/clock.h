#ifndef ETALON_BASE_CLOCK_H
#define ETALON_BASE_CLOCK_H

double clock_wall(void);       /* monotonic, s */
double clock_cpu(void);        /* of the whole process, all threads, s */
double clock_cpu_thread(void); /* of the calling thread, s */

#endif
