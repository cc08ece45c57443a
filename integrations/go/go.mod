module mien

go 1.19
