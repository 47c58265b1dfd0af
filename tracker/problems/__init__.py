"""What is wrong with the input: unused sensors, wrong clocks, missing messages."""
