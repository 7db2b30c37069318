#!/bin/sh
# array.sh
#SBATCH --array=1-4 --ntasks=1 --cpus-per-task=1
#SBATCH --output=out/part-%a.txt
part=$SLURM_ARRAY_TASK_ID
[ -e "out/$part/results.json" ] && resume=--resume
exec parallax suite scenarios --shard "$part/4" --out "out/$part" $resume
