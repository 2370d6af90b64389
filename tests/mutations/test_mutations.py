"""The table of mutations is of the code as it is: each in one place, with tests that exist."""

from mutation import TOP, read


def test_each_stands_once_in_its_file_and_its_tests_exist(tmp_path):
    for mutation in read():
        copy = tmp_path / mutation.file
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_text((TOP / mutation.file).read_text())
        mutation.apply(tmp_path)
        for file, _, name in (test.partition("::") for test in mutation.tests):
            assert f"def {name.partition('[')[0]}" in (TOP / file).read_text(), (mutation.wrong, file, name)
