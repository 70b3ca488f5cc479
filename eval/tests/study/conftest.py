from server.tests.preview.conftest import browser as browser
