// cpu_quota.h — how many processors a container lets this process use.

#ifndef CPU_QUOTA_H
#define CPU_QUOTA_H

// The processors that the control groups named in the text of cgroup_file
// (normally /proc/self/cgroup) grant, from the quotas of the file system
// mounted at root (normally /sys/fs/cgroup): version 2 (cpu.max) and version 1
// (cpu.cfs_quota_us), the least over the group and all that hold it.  Infinity
// when there is no limit or nothing can be read.
double cpu_quota(const char *cgroup_file, const char *root);

// A count of processors from a variable such as SLURM_CPUS_PER_TASK: its whole
// number, or 0 when text is NULL or anything but a positive number.
int cpu_count_of(const char *text);

#endif
