from tests.preview.conftest import browser as browser
