"""What is left when runs are killed, disks are full and files vanish, as a table."""
